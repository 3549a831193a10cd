// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstddef>
#include <vector>

#include "detectors/detail/lidar_template_fit.hpp"
#include "petal/calibration/boards.hpp"

namespace petal {

struct PlateEdgeLimits {
    double min_edge_coverage = 0.5;
    double max_inside = 0.15;
    double max_edge_rms = 0.012;
    int max_edge_points = 20000;
};

/// A board fitted to points on its edges alone.
struct PlateEdgeFit {
    PlateState state;
    std::size_t points = 0;    ///< on sides
    double coverage = 0.0;     ///< mean over the holes' sides: share of fifths with a point
    double inside = 0.0;       ///< points well inside the plate or a hole, as a share of all
    double edge_rms = 0.0;     ///< m, across the sides
    double side_common = 0.0;  ///< m, 1 sigma: error that the points of a side share
    double plane_rms = 0.0;    ///< m
    Matrix6d covariance = Matrix6d::Zero();  ///< of Exp(rho, phi) in the board's frame
    Eigen::Vector2d shift_sigma = Eigen::Vector2d::Zero();  ///< m
};

/// Least squares over the board's six degrees of freedom and the edges' two shifts, with Tukey's
/// weights: the points of a side lie at the edge as the beam sees it, on their rays, and in the
/// plane. `points`: LiDAR frame. False where too few points lie on sides.
bool fit_edges(const PlateTemplate& target, const PlateBeam& beam,
               const std::vector<Eigen::Vector3d>& points, const Eigen::Isometry3d& T_lidar_middle,
               PlateEdgeFit& fit);

}  // namespace petal
