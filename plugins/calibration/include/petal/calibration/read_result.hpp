// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <filesystem>

#include "petal/calibration/extrinsics.hpp"

namespace petal {

/// Reads what a calibration's result.json tells of its cameras: labels, T_camera_lidar, covariance
/// and the verdict. Intrinsics and residuals are not in it. \throws Error naming the file, line and
/// key: cannot be read, no JSON, no result, nothing solved, a matrix that is no rigid motion, a
/// covariance that is none, two entries of one camera and LiDAR.
Extrinsics read_result(const std::filesystem::path& file);

}  // namespace petal
