// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <vector>

#include "petal/calibration/correspondences.hpp"
#include "solvers/detail/board_set.hpp"
#include "solvers/detail/order_choice.hpp"

namespace petal {

/// Adds to each of `scenes` (one for each scene of `boards`, in their order) what the choice says
/// of it: decision, poses, boards and pairs with their covariances. `lidar_sigma` (m) is the noise
/// of the corners of LiDAR boards without a covariance.
void add_matched_pairs(const BoardSet& boards, const OrderChoice& choice, double lidar_sigma,
                       std::vector<CameraPairs>& scenes);

}  // namespace petal
