// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstddef>
#include <optional>
#include <vector>

#include "metrics/detail/plate_edges.hpp"
#include "petal/calibration/cloud.hpp"
#include "petal/run.hpp"

namespace petal {

/// Where the ray of one raw point passes through a board's plane, and where the point itself lies.
struct PlateRay {
    Eigen::Vector2d at = Eigen::Vector2d::Zero();    ///< board frame, m
    Eigen::Vector2d lean = Eigen::Vector2d::Zero();  ///< how `at` moves by 1 m of the plane's z
    double depth = 0.0;     ///< m along the ray behind the plane; negative before it
    double off = 0.0;       ///< m along z behind the plane
    std::size_t point = 0;  ///< its index in the cloud
};

/// A plane z = at_middle + by_x (x - x0) + by_y (y - y0) about the middle of a board.
struct PlatePlane {
    Eigen::Vector3d value = Eigen::Vector3d::Zero();  ///< at_middle (m), by_x, by_y
    Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
    double rms = 0.0;       ///< of the points' distances, m
    std::size_t count = 0;  ///< points

    double at(const Eigen::Vector2d& from_middle) const {
        return value.x() + value.tail<2>().dot(from_middle);
    }
};

/// The rays of a cloud that pass through a board's bounding box, `border` (m) wider, in the order
/// of the points. Linear in the points; points with NaN are left out. Empty where the sensor lies
/// in the board's plane, or behind it. \throws Cancelled
std::vector<PlateRay> plate_rays(const Run& run, const Cloud& cloud,
                                 const Eigen::Isometry3d& T_lidar_board, double width,
                                 double height, double border);

/// The plane through the points on the plate, farther than `from_edge` from its edges, within
/// `depth` of z = 0; robust against what does not belong to it. None for fewer than 30 points.
std::optional<PlatePlane> plate_plane(const std::vector<PlateRay>& rays, const PlateEdges& edges,
                                      double from_edge, double depth);

/// Moves the rays into the frame whose z = 0 is the plane: turned by less than a few degrees.
void flatten(std::vector<PlateRay>& rays, const PlatePlane& plane, const Eigen::Vector2d& middle);

}  // namespace petal
