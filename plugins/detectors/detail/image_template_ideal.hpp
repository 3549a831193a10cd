// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <Eigen/Core>
#include <vector>

#include "detectors/detail/image_layout.hpp"
#include "detectors/detail/image_template_model.hpp"
#include "detectors/detail/image_template_regions.hpp"
#include "petal/calibration/camera_model.hpp"

namespace petal {

/// A region as an ideal pinhole would see it.
struct IdealRegion {
    TemplateShape shape;           ///< ideal pixels
    Eigen::Matrix2d root, whiten;  ///< of its spread, and the inverse
    int index = 0;                 ///< in what it was made of
};

/// By rows; regions that an ideal pinhole cannot see are left out.
std::vector<IdealRegion> ideal_regions(const std::vector<ImageRegion>& regions,
                                       const CameraModel& camera);

/// The symmetric root of a spread, which must be positive definite.
Eigen::Matrix2d root_of(const Eigen::Matrix2d& spread);

Eigen::Matrix2d turn_by(double angle);

/// The affine map with this linear part that puts `board` at `image`.
Homography affine_about(const Eigen::Matrix2d& linear, const Eigen::Vector2d& board,
                        const Eigen::Vector2d& image);

/// False where the map squeezes the board as only a view from nearly the side does.
bool not_from_the_side(const Eigen::Matrix2d& linear);

}  // namespace petal
