// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <functional>
#include <vector>

#include "petal/run.hpp"

namespace petal {

/// A line in a plane: `point` + s * `direction`.
struct PlanarLine {
    Eigen::Vector2d point = Eigen::Vector2d::Zero();  ///< mean of its points, m
    Eigen::Vector2d direction = Eigen::Vector2d::UnitX();
    std::size_t count = 0;  ///< points within the threshold
};

struct LineSearchParams {
    double line_threshold = 0.01;  ///< m: delta_d^Line of (4)
    double reach = 0.5;  ///< m: points of a line lie at most that far from its first point
    std::size_t min_points = 6;
    std::size_t max_lines = 20;
    double confidence = 0.99;
    int max_iterations = 600;  ///< for each line
};

/// RANSAC for lines with removal (equation (4), lines 13 to 18 of Algorithm 1), in plane
/// coordinates: there the cross product of (4) is a scalar, and the lines need no projection onto
/// the plane afterwards. The best supported first.
std::vector<PlanarLine> find_lines(const std::vector<Eigen::Vector2d>& points,
                                   const LineSearchParams& params, Rng& rng,
                                   const std::function<void()>& poll);

}  // namespace petal
