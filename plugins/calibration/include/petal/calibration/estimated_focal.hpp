// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <mrpt/img/TCamera.h>

#include "petal/calibration/extrinsics.hpp"

namespace petal {

/// The intrinsics that the pose of `solved` belongs to: `given` (those of the data), with the focal
/// length scaled where it was estimated with the pose. `solved.model` may be empty, as an earlier
/// result's is.
mrpt::img::TCamera with_estimated_focal(mrpt::img::TCamera given, const CameraExtrinsics& solved);

}  // namespace petal
