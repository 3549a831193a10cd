// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <mrpt/img/TCamera.h>

namespace petal {

/// True where both cameras have the same size, intrinsics and distortion, to the bit.
bool same_projection(const mrpt::img::TCamera& a, const mrpt::img::TCamera& b);

}  // namespace petal
