// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstddef>
#include <vector>

#include "detectors/detail/lidar_template_rays.hpp"
#include "detectors/detail/lidar_template_shape.hpp"

namespace petal {

/// The plane of a plate from its own points.
struct PlaneOfPlate {
    std::size_t points = 0;
    double rms = 0.0;       ///< m, across the plane
    double common = 0.0;    ///< m, 1 sigma: error that the points of a fifth by a fifth share
    double flatness = 0.0;  ///< m: RMS of the means of these parts, less what noise makes of it
    /// Of (rho_z, phi_x, phi_y) in the board's frame about its middle.
    Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
};

/// Turns and shifts the board (frame of PlateShape) into the plane of those rays that hit it
/// farther than `margin` from every edge; its middle stays on its ray. False where there are too
/// few of them.
bool turn_into_plate(const PlateShape& shape, const RayBundle& rays, double margin,
                     Eigen::Isometry3d& T_lidar_middle);

/// How well these rays tell the plane.
PlaneOfPlate measure_plate(const PlateShape& shape, const RayBundle& rays, double margin);

}  // namespace petal
