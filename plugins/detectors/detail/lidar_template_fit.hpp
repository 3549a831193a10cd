// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <Eigen/Core>
#include <vector>

#include "detectors/detail/lidar_template_likelihood.hpp"
#include "detectors/detail/lidar_template_placement.hpp"
#include "detectors/detail/lidar_template_plane.hpp"
#include "detectors/detail/lidar_template_rays.hpp"
#include "detectors/detail/lidar_template_shape.hpp"
#include "petal/calibration/boards.hpp"

namespace petal {

/// The target as its two uses need it.
struct PlateTemplate {
    explicit PlateTemplate(const Target& target)
        : holes(target, PlateShape::Sides::holes), all(target, PlateShape::Sides::all) {}
    PlateShape holes;  ///< what the place in the plane is fitted to
    PlateShape all;    ///< what tells plate from background
};

/// A board fitted to the rays around it.
struct PlateFit {
    PlateState state;
    RayBundle rays;                          ///< in the plane of the board, about its middle
    ToldRays zone;                           ///< those of the fit
    PlaneOfPlate plane;                      ///< from the plate's own points
    Matrix6d covariance = Matrix6d::Zero();  ///< of Exp(rho, phi) in the board's frame
    Eigen::Vector2d shift_sigma = Eigen::Vector2d::Zero();  ///< m
    Eigen::Vector2d side_common = Eigen::Vector2d::Zero();  ///< m, 1 sigma: see common_of()
    double gain = 0.0;  ///< how much better the template tells hits from misses than their share
                        ///< alone does: 0 not at all, 1 each one
    Eigen::Vector2d stretch = Eigen::Vector2d::Zero();  ///< of the holes, fitted afterwards
    Eigen::Vector2d stretch_sigma = Eigen::Vector2d::Zero();
    double density = 0.0;  ///< rays a m^2 of the plate
};

/// 1 sigma of the edges' shifts about zero, m.
struct PlateBeam {
    double shift_level_sigma = 0.006;
    double shift_upright_sigma = 0.010;
    double edge_sigma = 0.020;  ///< of points on edges alone, which filters chose
};

/// Fits the target to the rays around a placement. False where they do not fix it.
bool fit_plate(const PlateTemplate& target, const PlateBeam& beam, RayBundle rays,
               const PlatePlacement& placement, PlateFit& fit);
/// The same from the state that a fit to some of these rays found.
bool fit_plate(const PlateTemplate& target, const PlateBeam& beam, RayBundle rays,
               const PlateState& start, PlateFit& fit);

}  // namespace petal
