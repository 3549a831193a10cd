// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>
#include <vector>

#include "detectors/detail/lidar_template_rays.hpp"
#include "detectors/detail/lidar_template_shape.hpp"

namespace petal {

/// Where a board may lie in a plane: its middle in the plane's frame, the angle from the plane's x
/// to the board's, and how well hits and misses agree: 1 for a board, 1/3 for a plate without
/// holes, -1/3 for a wall.
struct PlatePlacement {
    Eigen::Vector2d middle = Eigen::Vector2d::Zero();
    double angle = 0.0;
    double score = 0.0;
};

/// Finds the target among rays. Correlates hits (+1), misses (-1) and places where no ray returned
/// although many should have (-1) with the target: plate +, holes -, a ring around the outline -,
/// each kind with the same weight, in all turns that look different. What is hidden counts for
/// nothing.
class PlatePlacer {
   public:
    /// For rays within `radius` (m) of a place.
    PlatePlacer(const PlateShape& shape, double radius);
    /// The best first, at most `keep`, no two alike; coarsely where no score comes near `least`.
    std::vector<PlatePlacement> place(const RayBundle& rays, std::size_t keep, double least) const;

   private:
    const PlateShape& shape_;
    double radius_;
    std::vector<cv::Mat> coarse_, fine_;  ///< of the kernel of each turn
};

/// The same for points on edges alone: correlates them with the sides.
std::vector<PlatePlacement> place_edges(const PlateShape& shape,
                                        const std::vector<Eigen::Vector2d>& points, double radius,
                                        std::size_t keep);

}  // namespace petal
