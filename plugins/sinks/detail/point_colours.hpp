// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <opencv2/core.hpp>
#include <optional>
#include <vector>

#include "petal/calibration/cloud.hpp"
#include "petal/calibration/images.hpp"
#include "petal/run.hpp"

namespace petal {

/// When a point counts as hidden behind another: it lies in the same cell of the image, and farther
/// by more than max(slack, slack_share times its own depth).
struct Occlusion {
    /// Side of a cell, px; 0: 4, doubled up to 32 until occupied cells hold four points on average,
    /// so that the gaps between the points of a near surface let nothing through.
    int cell_px = 0;
    double slack = 0.1;  ///< m
    /// Surfaces seen at a flat angle (a floor) grow deeper within a cell.
    double slack_share = 0.05;
};

struct PointColour {
    std::uint8_t red = 0, green = 0, blue = 0;
};

/// The colours that one camera gives to the points of a cloud. Every point is projected once, with
/// distortion; a grid of the nearest depths says which points others hide. Time and memory are
/// linear in points and pixels (8 bytes a point); neither cloud nor photo is copied, so both
/// must outlive this.
class PointColours {
   public:
    /// \throws Error where the intrinsics are no camera; Cancelled.
    PointColours(const Run& run, const Cloud& cloud, const CameraImage& image,
                 const Eigen::Isometry3d& T_camera_lidar, const Occlusion& occlusion = {});
    /// The same for some of the points, which alone hide each other: what is told of point k is
    /// then of the cloud's points[k].
    PointColours(const Run& run, const Cloud& cloud, const std::vector<std::size_t>& points,
                 const CameraImage& image, const Eigen::Isometry3d& T_camera_lidar,
                 const Occlusion& occlusion = {});

    /// Of the nearest pixel. None where the point is not finite, lies outside the photo or behind
    /// the camera, or is hidden.
    std::optional<PointColour> of(std::size_t point) const;
    bool hidden(std::size_t point) const;  ///< lies in the photo, but behind another point
    /// Where a point lies on the photo, hidden or not; none where it is not on it.
    struct Place {
        std::uint32_t column, row;  ///< px
        float depth;                ///< m along the camera's axis
    };
    std::optional<Place> place_of(std::size_t point) const;
    int cell_px() const { return cell_px_; }

   private:
    struct Seen {
        std::uint32_t pixel = kOutside;  ///< row times width plus column
        float depth = 0.0F;              ///< m along the camera's axis
    };
    static constexpr std::uint32_t kOutside = 0xFFFFFFFF;

    /// Projects so many points of the cloud, index_of(0), index_of(1), ..., and fills the grid.
    template <class IndexOf>
    void project(const Run& run, const Cloud& cloud, std::size_t count, const IndexOf& index_of,
                 const mrpt::img::TCamera& camera, const Eigen::Isometry3d& T_camera_lidar);
    /// Fills the grid of nearest depths; returns how many points an occupied cell holds on average.
    double fill_grid(int cell_px);
    std::size_t cell_of(std::uint32_t pixel) const;

    cv::Mat photo_;  ///< shares the packet's pixels
    Occlusion occlusion_;
    std::vector<Seen> seen_;
    int cell_px_ = 0;
    std::size_t columns_ = 0;  ///< of the grid
    std::vector<float> nearest_;
};

}  // namespace petal
