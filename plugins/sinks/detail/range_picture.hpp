// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <opencv2/core.hpp>

#include "petal/calibration/cloud.hpp"
#include "sinks/detail/point_colours.hpp"

namespace petal {

/// How points lie over a photo.
struct RangePictureStyle {
    int point_px = 2;                 ///< side of a point's square
    std::size_t max_points = 200000;  ///< of a larger cloud, evenly spaced ones
    double min_range = 0.0;   ///< m; both 0: what all but 2 % at either end of the points have
    double max_range = 0.0;   ///< m
    double brightness = 0.6;  ///< of the photo beneath, 0 to 1
};

/// The photo in grey, the points that are not hidden over it by their distance from the LiDAR (near
/// red, far blue, by its logarithm), nearer ones in front, and a scale in metres below. BGR.
cv::Mat range_picture(const cv::Mat& photo, const Cloud& cloud, const PointColours& seen,
                      const RangePictureStyle& style);

}  // namespace petal
