// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <optional>
#include <string>
#include <vector>

#include "detectors/detail/lidar_template_edges.hpp"
#include "detectors/detail/lidar_template_fit.hpp"
#include "detectors/detail/lidar_template_judge.hpp"
#include "detectors/detail/lidar_template_search.hpp"
#include "petal/calibration/boards.hpp"
#include "petal/calibration/cloud.hpp"

namespace petal {

/// What one candidate came to.
struct PlateAttempt {
    PlateCandidate plate;
    std::optional<LidarBoard> board;
    Eigen::Vector3d middle = Eigen::Vector3d::Zero();  ///< of the board, LiDAR frame
    double merit = 0.0;      ///< of a board: of two on one place the better one stays
    double closeness = 0.0;  ///< of a failure: the higher the nearer to a board
    std::string miss;        ///< of a failure: what was found
    std::string threshold;   ///< of a failure: what was needed
    std::string finding;     ///< what casts doubt on the target file; empty: nothing

    /// For the picture: places in the frame of PlateShape.
    std::vector<Eigen::Vector2d> hits, misses;
    bool placed = false;
};

/// Some of the rays around a plate, and where the target may lie among them.
struct PlacedPlate {
    PlateCandidate plate;
    RayBundle rays;
    std::vector<PlatePlacement> placements;
    double score() const { return placements.empty() ? -1.0 : placements.front().score; }
    Eigen::Vector3d middle(const PlatePlacement& placement) const {
        return rays.T_lidar_plane *
               Eigen::Vector3d(placement.middle.x(), placement.middle.y(), 0.0);
    }
};
/// m, from a plate's middle: the rays that are looked at.
double reach_of(const PlateTemplate& target);

PlacedPlate place_on_rays(const PlateTemplate& target, const PlatePlacer& placer,
                          const CloudDirections& cloud, const PlateCandidate& plate);

/// Fits the target to the rays around a plate: to some of them first, and where that comes near a
/// board to all of them. Where a placement overlaps one of the `boards` (their middles) found
/// already it is left out.
PlateAttempt try_rays(const PlateTemplate& target, const PlateBeam& beam, const PlateLimits& limits,
                      const CloudDirections& cloud, const PlacedPlate& placed,
                      const std::vector<Eigen::Vector3d>& boards, const Target& names);

/// Tries it on points of edges near a plane patch.
PlateAttempt try_edges(const PlateTemplate& target, const PlateBeam& beam,
                       const PlateEdgeLimits& limits, double max_shift,
                       const std::vector<Eigen::Vector3d>& points, const PlateCandidate& patch,
                       const Target& names);

/// The board at T_lidar_middle, in that of its like orders whose x is nearest to the right of an
/// observer at the sensor. `covariance`: of T_lidar_middle Exp(rho, phi).
LidarBoard board_at(const PlateTemplate& target, const Target& names,
                    const Eigen::Isometry3d& T_lidar_middle, const Matrix6d& covariance);

}  // namespace petal
