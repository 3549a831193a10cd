// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <optional>

#include "solvers/detail/joint_input.hpp"
#include "solvers/detail/joint_solve.hpp"

namespace petal {

/// The minimum that explains a group of cameras best, and the next one.
struct JointMinima {
    struct Other {
        std::size_t camera = 0;  ///< whose pose differs
        double angle = 0.0;      ///< rad
        double distance = 0.0;   ///< m
        double squares = 0.0;    ///< what its whitened squares are more than the best one's
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

}  // namespace petal
