// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <opencv2/core.hpp>
#include <vector>

#include "petal/run.hpp"
#include "simulation/camera/pixel_rays.hpp"
#include "simulation/camera/shading.hpp"

namespace petal::simulation {

/// The radiance of a pixel, which has an edge in it or not.
struct Pixel {
    static constexpr int kCells = 4;  ///< a side, in those that were looked at closely

    Eigen::Vector3f mean = Eigen::Vector3f::Zero();  ///< over its area; blue, green, red
    bool divided = false;
    /// Row by row, what each cell differs by from the mean. Only where it is divided.
    std::array<Eigen::Vector3f, kCells * kCells> cells;
};

/// Radiance averaged over the pixels' areas.
///
/// First one sample at each corner of the pixels. A straight edge that crosses a pixel parts its
/// corners, so that a pixel whose corners are alike, as are its neighbours', is done. All others
/// get eight samples inside, and those in which there is something to see get 64, or 16 where no
/// board is.
class Picture {
   public:
    /// \throws Cancelled
    Picture(const PixelRays& rays, const Shading& shading, const Run& run);

    Pixel pixel(int column, int row) const;

   private:
    /// What a pixel or one next to it has. Dilation keeps the largest.
    enum Detail : unsigned char { kSmooth, kPattern, kEdge };
    class Tally;

    std::size_t index(int column, int row) const {
        return static_cast<std::size_t>(row) * stride_ + static_cast<std::size_t>(column);
    }
    Tally at_corners(int column, int row) const;
    Sight look(int column, int row, const Eigen::Array2d& place) const;

    const PixelRays& rays_;
    const Shading& shading_;
    std::size_t stride_;
    std::vector<Sight> corners_;
    cv::Mat detail_;
};

}  // namespace petal::simulation
