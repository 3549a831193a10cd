// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <Eigen/Geometry>
#include <functional>
#include <vector>

#include "solvers/detail/board_set.hpp"

namespace petal {

/// Poses T_camera_lidar from which the boards of all scenes may be explained, the most promising
/// first: those of every single (LiDAR board, image board) in every rotation and both planar minima
/// (IPPE), and those that two of them, of one scene or of two, agree on. Every pose comes with what
/// BoardSet::explained tells of it; poses that lead to the same matches from nearby are told once.
struct PoseHypothesis {
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    BoardSet::Explained explained;
};
/// `poll` is called now and then and may throw, to cancel.
std::vector<PoseHypothesis> pose_hypotheses(const BoardSet& boards,
                                            const std::function<void()>& poll);

/// Whether a search that starts from either leads to the same minimum, in all likelihood.
bool near_pose(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b);

}  // namespace petal
