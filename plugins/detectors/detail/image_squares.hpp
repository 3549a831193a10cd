// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <Eigen/Core>
#include <array>
#include <functional>
#include <opencv2/core.hpp>
#include <vector>

namespace petal {

/// Which contours count as a hole: section III.C.1 of the letter.
struct SquareLimits {
    double min_area = 5e-5;           ///< of the image's area
    double max_area = 0.06;           ///< of the image's area
    double max_rectangularity = 1.5;  ///< equation (6); 1 for a rectangle
    double min_circularity = 0.5;     ///< equation (7); pi/4 for a square
    double max_circularity = 0.95;    ///< equation (7); 1 for a circle
    int levels = 12;                  ///< global thresholds of the sweep
};

/// A dark region that looks like a square hole.
struct SquareCandidate {
    std::array<Eigen::Vector2d, 4> corners;  ///< raw pixels, clockwise, the top left one first
    Eigen::Vector2d center = Eigen::Vector2d::Zero();
    double area = 0.0;  ///< of the quadrilateral, px^2
    double rectangularity = 0.0;
    double circularity = 0.0;
    int votes = 1;  ///< binary images in which it was seen
};

struct SquareSearch {
    std::vector<SquareCandidate> squares;  ///< by row, then by column; each region once
    int borders = 0;  ///< hole borders inside the area range, over all binary images
};

/// The four corners of a contour by the letter's rule of maximum distances (section III.C.2),
/// clockwise in the image. The letter starts at a random point; here the start is the point
/// farthest from the contour's centroid, which is a corner already and the same in every run.
std::array<Eigen::Vector2d, 4> corners_by_distance(const std::vector<cv::Point>& contour);

/// Dark square regions in an 8 bit grey image, without a hand-set threshold: the contours of a
/// sweep of global levels (quantiles of the image, so that no grey level is special) and of local
/// means at three scales. Deterministic. `check` is called between the binary images, and may throw
/// to end the search.
SquareSearch find_squares(const cv::Mat& grey, const SquareLimits& limits,
                          const std::function<void()>& check = nullptr);

}  // namespace petal
