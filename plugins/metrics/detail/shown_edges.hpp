// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <vector>

#include "metrics/detail/plate_edges.hpp"
#include "metrics/detail/plate_rays.hpp"
#include "petal/run.hpp"

namespace petal {

/// A ray beside an edge: it hit the plate or went past it.
struct EdgeRay {
    std::size_t edge = 0;
    double inside = 0.0;                               ///< m, PlateEdges::Place::inside
    Eigen::Vector2d inward = Eigen::Vector2d::Zero();  ///< unit
    Eigen::Vector2d at = Eigen::Vector2d::Zero();      ///< board frame, m
    std::size_t point = 0;
    bool hit = false;
};

/// The rays within `band` of an edge. A point nearer to the plane than `depth` along its ray is a
/// hit, one behind it a miss; one before it (something stands there) tells nothing.
std::vector<EdgeRay> edge_rays(const std::vector<PlateRay>& rays, const PlateEdges& edges,
                               double band, double depth);

/// Where an edge shows: the probability of a hit is 1 / (1 + exp(-slope (inside + out))).
struct ShownEdge {
    double out = 0.0;    ///< m: how far the plate reaches beyond the target's edge
    double sigma = 0.0;  ///< of out, m
    double slope = 0.0;  ///< 1/m
};

/// For each edge where it shows, by maximum likelihood over the rays beside it; what contradicts
/// strongly (an occluder, a hit far outside) is left out. None where fewer than 15 hits or misses
/// are there to tell. \throws Cancelled
std::vector<std::optional<ShownEdge>> shown_edges(const Run& run, const std::vector<EdgeRay>& rays,
                                                  std::size_t edges);

/// How far the plate lies aside of the place that its shown edges have.
struct PlateShift {
    Eigen::Vector3d value = Eigen::Vector3d::Zero();  ///< x, y (m), roll about the middle (rad)
    Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
};

/// By maximum likelihood over some of the rays, the edges known from all. None where they do not
/// tell all three numbers.
std::optional<PlateShift> plate_shift(const std::vector<EdgeRay>& rays,
                                      const std::vector<std::optional<ShownEdge>>& shown,
                                      const Eigen::Vector2d& middle);

}  // namespace petal
