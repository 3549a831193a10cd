// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <string>
#include <vector>

namespace petal {

/// 32 numbers of a board's 16 corners come from about 8 lines.
constexpr double kBoardRedundancy = 4.0;

/// The covariance of a board's corners together, 2N x 2N, u0 v0 u1 v1 ..., px^2: `joint` where it
/// is known, else the corners' own (`each`; 1 px^2 where it tells none) times `redundancy`, since
/// corners that share their lines are not independent.
Eigen::MatrixXd corner_covariance(const Eigen::MatrixXd& joint,
                                  const std::vector<Eigen::Matrix2d>& each, std::size_t corners,
                                  double redundancy = kBoardRedundancy);

/// Why a symmetric matrix is no covariance: NaN, infinity, or a variance below -1e-6 of the largest
/// (what rounding makes of zero is 1e-15). Empty where it is one, also of less than full rank.
std::string covariance_fault(const Eigen::MatrixXd& covariance);

}  // namespace petal
