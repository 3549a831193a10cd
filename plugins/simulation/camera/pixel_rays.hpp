// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "petal/calibration/camera_model.hpp"
#include "petal/run.hpp"

namespace petal::simulation {

/// The directions in which a camera's pixels look, any place inside them, beyond the image's rim by
/// a margin of pixels. Camera frame.
///
/// The camera model is inverted at the corners of the pixels; between them directions are
/// interpolated, which is off by less than 0.0005 px down to focal lengths of 350 px.
class PixelRays {
   public:
    /// \throws Cancelled
    PixelRays(const CameraModel& model, int margin, const Run& run);

    /// Pixels, with the margin on both sides. Pixel (margin, margin) is the image's first.
    int columns() const { return columns_; }
    int rows() const { return rows_; }
    /// The direction (any length) of a pixel's upper left corner; column up to columns(), row up to
    /// rows(). Zero where the camera model has none.
    const Eigen::Vector3d& corner(int column, int row) const {
        return corners_[static_cast<std::size_t>(row) * (static_cast<std::size_t>(columns_) + 1) +
                        static_cast<std::size_t>(column)];
    }
    /// Whether the model reaches all corners of a pixel.
    bool exists(int column, int row) const;
    /// The direction (any length) inside a pixel that exists: (0, 0) is its upper left corner,
    /// (1, 1) its lower right one.
    Eigen::Vector3d inside(int column, int row, double right, double down) const {
        return (1.0 - down) *
                   ((1.0 - right) * corner(column, row) + right * corner(column + 1, row)) +
               down *
                   ((1.0 - right) * corner(column, row + 1) + right * corner(column + 1, row + 1));
    }

   private:
    int columns_, rows_;
    std::vector<Eigen::Vector3d> corners_;
};

}  // namespace petal::simulation
