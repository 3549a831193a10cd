// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <vector>

#include "petal/calibration/boards.hpp"
#include "petal/calibration/camera_model.hpp"

namespace petal {

/// Where a distortion turns back on the way to the image's corner, px from the principal point.
struct FoldAtCorner {
    double fold_px = 0.0;    ///< the distorted radius grows up to here only
    double corner_px = 0.0;  ///< of the image's corner
};

/// The corner of the image farthest beyond its fold; none where the distorted radius grows up to
/// every corner.
std::optional<FoldAtCorner> fold_inside_image(const CameraModel& model);

/// How straight the edges of boards are after undistortion.
struct Straightness {
    double rms_px = 0.0;       ///< of corners from the lines through their rows and columns
    double expected_px = 0.0;  ///< the same by the corners' covariances
    std::size_t count = 0;     ///< deviations
};

/// Sums over boards.
class StraightnessSum {
   public:
    /// The rows and columns of three corners and more of one board, `target` in the order of
    /// Target::corners(); ideal pixels. Boards with another number of corners, or corners that the
    /// model does not reach, tell nothing.
    void add(const CameraModel& model, const ImageBoard& board,
             const std::vector<Eigen::Vector2d>& target);
    Straightness result() const;

   private:
    void add_line(const std::vector<Eigen::Vector2d>& ideal, const ImageBoard& board,
                  const std::vector<std::size_t>& members);

    double squares_ = 0.0, expected_ = 0.0;
    double freedoms_ = 0.0;
    std::size_t count_ = 0;
};

}  // namespace petal
