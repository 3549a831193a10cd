// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstddef>
#include <optional>
#include <vector>

#include "detectors/detail/board_line_grid.hpp"
#include "detectors/detail/board_line_pattern.hpp"
#include "petal/calibration/boards.hpp"

namespace petal {

/// A board fitted to the points on the sides of its holes.
struct BoardFit {
    Eigen::Isometry3d T_lidar_board = Eigen::Isometry3d::Identity();
    Eigen::Vector2d inflation = Eigen::Vector2d::Zero();        ///< m: d_x, d_y
    Eigen::Vector2d inflation_sigma = Eigen::Vector2d::Zero();  ///< m
    Matrix6d covariance = Matrix6d::Zero();  ///< left perturbation (rho, phi), m and rad
    double line_rms = 0.0;                   ///< m: across the sides, of the points that count
    double line_common = 0.0;                ///< m, 1 sigma: error that a side's points share
    double plane_rms = 0.0;                  ///< m: across the plane
    double plane_common = 0.0;               ///< m, 1 sigma: error that a group's points share
    PatternScore score;
};

/// Least squares over the six degrees of freedom of the board and d_x, d_y together (Gauss-Newton,
/// Tukey's weights, sides assigned anew in each step):
///
///     x_i = x_k + s_k d_x  on left and right sides,  y_i = y_k + s_k d_y  on upper and lower ones,
///     z_j = 0,             (x_i, y_i, 0) where the ray to p_i meets the board, z_j of T^-1 p_j
///
/// Points `plate` (LiDAR frame) tell the plane; empty: the points on the sides do, whose ranges are
/// those of beams that the rim cuts.
///
/// The covariance does not take the points of one side as independent: they share what the beam and
/// the background do to that side. A common error of each side is estimated beside that of the
/// points (variance components), so a side counts as about one measurement however many points lie
/// on it; across the plane likewise, by cells of a fifth of the plate. The last steps weigh the
/// points so too. d_x and d_y are estimated with the pose: the covariance is marginal over them.
/// `prior_sigma` is that of d about zero, m.
///
/// `points`: LiDAR frame; `start`: the board; None where too few points lie on sides to fix it.
std::optional<BoardFit> refine_board(const HoleGrid& grid,
                                     const std::vector<Eigen::Vector3d>& points,
                                     const std::vector<Eigen::Vector3d>& plate,
                                     const Eigen::Isometry3d& start,
                                     const Eigen::Vector2d& inflation, double prior_sigma);

}  // namespace petal
