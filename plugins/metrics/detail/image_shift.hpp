// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "petal/calibration/boards.hpp"
#include "petal/calibration/images.hpp"

namespace petal {

/// How far a board moved in the image, as a whole, from one image of a camera to another.
struct ImageShift {
    std::string from, to;                          ///< "first", "middle", "last"
    double seconds = 0.0;                          ///< between them
    Eigen::Vector2d px = Eigen::Vector2d::Zero();  ///< median over the corners
    double sigma_px = 0.0;                         ///< of its length
    double metres = 0.0;                           ///< its length at the board's range
    double sigma_metres = 0.0;
    std::size_t corners = 0;  ///< that were found in both
};

/// Fewer corners tell no shift.
constexpr std::size_t kFewestShiftCorners = 4;

/// A board in all images that were looked at.
struct ImageShifts {
    /// An image in which too few corners were found again.
    struct Lost {
        std::string image;        ///< "first", "middle", "last"
        double seconds = 0.0;     ///< from the image that the board was measured in
        std::size_t corners = 0;  ///< that were found
    };
    std::vector<ImageShift> shifts;  ///< between every two images that it was found in
    std::vector<Lost> lost;  ///< none where not even its own image shows the corners well enough
};

/// The images of one camera in the order of their stamps: the first, the middle one and the last,
/// where there are so many.
std::vector<const CameraImage*> spread_images(const Images& images, const std::string& camera);

/// The image that boards of this camera are measured in; null where there is none.
const CameraImage* board_image(const Images& images, const std::string& camera);

/// The shifts of a board's corners between every two of these images. In each the board is found
/// again as a whole, up to 40 px from where it is in `reference` (the image that it was measured
/// in), by correlation; then its corners by their gradients (cv::cornerSubPix). `radius_m` is that
/// of the target's corners, see corner_radius: together with theirs in the image it tells metres.
ImageShifts image_shifts(const std::vector<const CameraImage*>& images,
                         const CameraImage& reference, const ImageBoard& board, double radius_m);

/// The square root of the larger eigenvalue of the points' scatter about their mean: the extent
/// along the direction that an oblique view shortens least.
double corner_radius(const std::vector<Eigen::Vector2d>& points);

}  // namespace petal
