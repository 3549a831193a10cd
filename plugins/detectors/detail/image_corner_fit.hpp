// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <Eigen/Core>
#include <vector>

#include "detectors/detail/image_corner_covariance.hpp"
#include "detectors/detail/image_hole_sides.hpp"
#include "detectors/detail/image_layout.hpp"
#include "petal/calibration/camera_model.hpp"

namespace petal {

struct RefinedBoard;

/// px: no photo's edge points scatter less; keeps weights finite on a rendered image.
inline constexpr double kLeastScatter = 0.02;

/// From edge points to corners. Each hole side is a line through its own edge points, with the
/// board's geometry (homography and common inset) as the prior: both ends may be off by `tolerance`
/// (m, 1 sigma). Corners are where lines meet.
class CornerFit {
   public:
    CornerFit(const HoleLayout& layout, const CameraModel& camera, double tolerance,
              double sigma_floor_px)
        : layout_(layout),
          camera_(camera),
          tolerance_(tolerance),
          sigma_floor_px_(sigma_floor_px) {}

    /// Reads board_to_image, side_measured, hole_inset, wall and wall_sigma of `board`; fills
    /// corners, their covariances (single and joint) and the two RMS. False where sides do not
    /// meet, or a corner is not in the camera's view.
    bool fit(const std::vector<SidePoint>& points, RefinedBoard& board) const;

   private:
    struct SideLine {
        double offset = 0.0;  ///< px, outwards from the homography's line, at the middle
        double tilt = 0.0;    ///< px, further offset at the end (at the start: minus that)
        double offset_variance = 0.0;
        double tilt_variance = 0.0;
        MeasuredSide own;
    };

    std::vector<SideLine> fit_lines(const std::vector<SidePoint>& points,
                                    RefinedBoard& board) const;
    bool intersect(const std::vector<SideLine>& lines, const std::vector<SidePoint>& points,
                   RefinedBoard& board) const;

    const HoleLayout& layout_;
    const CameraModel& camera_;
    double tolerance_;
    double sigma_floor_px_;
};

}  // namespace petal
