// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <optional>
#include <vector>

#include "solvers/detail/board_set.hpp"

namespace petal {

/// How well an order fits, with the noise of both sensors. Each board counts as one measurement of
/// its six numbers, where the camera sees it against where the LiDAR has it: its corners share the
/// few lines they were cut from and the LiDAR's one pose, so they are no independent numbers.
struct OrderChi2 {
    double chi2 = 0.0;           ///< at its own minimum near the pose
    int degrees_of_freedom = 0;  ///< 6 a board, less 6 for the pose
};
/// `lidar_sigma` (m, a corner along each axis) is the noise of LiDAR boards without a covariance.
/// None where a corner does not project at `pose`, or a covariance is none: no order may count as a
/// perfect fit for that.
std::optional<OrderChi2> order_chi2(const BoardSet& boards, const std::vector<BoardMatch>& matches,
                                    const Eigen::Isometry3d& pose, double lidar_sigma);

}  // namespace petal
