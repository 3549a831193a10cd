// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "solvers/detail/joint_input.hpp"
#include "solvers/detail/joint_solve.hpp"

namespace petal {

/// The minimum that explains a group of cameras best, and the next one.
struct JointMinima {
    struct Other {
        std::size_t camera = 0;  ///< whose pose differs
        double angle = 0.0;      ///< rad
        double distance = 0.0;   ///< m
        /// What its whitened squares are more than the best one's; less than zero where a prior
        /// keeps one that is not the least.
        double squares = 0.0;
    };
    JointSolution best;
    std::optional<Other> other;
};

/// Solves from every pose that might be one: those that the matcher found; where it tells none, or
/// the camera saw one board only (which has two planar minima), also starts of its own. They are
/// refined on the corners first, and the distinct ones with similar residuals go into the joint
/// problem. Where a prior chose the order, the minimum nearest to the matcher's pose is taken.
/// None where no start puts everything in front of the cameras.
std::optional<JointMinima> search_joint(const JointInput& input, const JointOptions& options);

/// Of `others`, that with the least squares which is not `best` again: the camera whose pose
/// differs most is told. None where all are the same.
std::optional<JointMinima::Other> nearest_other(const JointSolution& best,
                                                const std::vector<JointSolution>& others);

/// The cameras (indices into `input.cameras`) that no start leads to a pose of: with one of these
/// the whole group has none.
std::vector<std::size_t> cameras_without_pose(const JointInput& input);

}  // namespace petal
