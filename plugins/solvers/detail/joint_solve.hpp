// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "solvers/detail/joint_model.hpp"

namespace petal {

/// "t within 10 cm of ...": on the fourth column of one camera's T_camera_lidar.
struct TranslationPrior {
    std::size_t camera = 0;
    Eigen::Vector3d translation = Eigen::Vector3d::Zero();  ///< m
    double sigma = 0.1;                                     ///< m
};

struct JointOptions {
    std::string robust_loss = "huber";  ///< none, huber, cauchy
    double range_offset_sigma = 0.01;   ///< m, of a constant offset of the LiDAR's ranges
    std::vector<bool> free_focal;       ///< of each camera; empty: none is free
    std::optional<TranslationPrior> prior;
    std::optional<std::size_t> without_scene;  ///< as if that scene had not been taken
    std::function<void()> poll;  ///< called before each round of solving; may throw, to cancel
};

/// A minimum of the joint problem.
struct JointSolution {
    JointState state;
    /// Of each board: its LiDAR's chi-square and what its images have more than each of them has at
    /// the pose that fits it alone. 6 numbers a view. Zero where its scene is left out.
    std::vector<double> board_chi2;
    /// With its weight by the robust loss. 2 / redundancy numbers a point.
    std::vector<double> point_chi2;
    double chi2 = 0.0;     ///< all together and the range offset's, without the prior
    double numbers = 0.0;  ///< how many independent numbers that are
    double squares = 0.0;  ///< of every whitened error: to compare minima with
};

/// A range offset that all boards have in common is a nuisance: it is free but for its sigma,
/// so that the weights know of it, and is not told.
///
/// Least squares from the cameras' poses `T_camera_lidar`; boards start where the LiDAR saw them.
/// Weights of the robust loss are found by repeated solving. One thread, so the same bytes
/// always. None where a corner or point does not project at the start, or Ceres cannot go on.
std::optional<JointSolution> solve_joint(const JointModel& model, const JointOptions& options,
                                         const std::vector<Eigen::Isometry3d>& T_camera_lidar);
/// The same from a whole state.
std::optional<JointSolution> solve_joint(const JointModel& model, const JointOptions& options,
                                         const JointState& start);

}  // namespace petal
