// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <Eigen/Core>
#include <opencv2/core.hpp>
#include <optional>
#include <vector>

namespace petal {

/// Where the grey value rises most along a line through the image.
struct EdgePoint {
    double offset = 0.0;  ///< px from the start, along the direction
    double strength =
        0.0;  ///< grey levels that the edge rises by, for an edge no wider than the filter
};

/// Sub-pixel edges in an 8 bit grey image: a profile (bilinear) along a direction, the derivative
/// of a Gaussian over it, and a parabola through the largest value.
class EdgeSampler {
   public:
    explicit EdgeSampler(const cv::Mat& grey);

    /// The steepest rise within `reach` px of `start` along the unit vector `direction`. None where
    /// there is no rise, where it is steepest at the end of the range, or outside the image.
    std::optional<EdgePoint> steepest_rise(const Eigen::Vector2d& start,
                                           const Eigen::Vector2d& direction, double reach) const;
    /// Bilinear grey value; none outside the image.
    std::optional<double> grey(const Eigen::Vector2d& p) const;

   private:
    cv::Mat grey_;
    std::vector<double> kernel_;
};

}  // namespace petal
