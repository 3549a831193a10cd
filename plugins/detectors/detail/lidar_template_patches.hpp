// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <Eigen/Core>
#include <functional>
#include <optional>
#include <vector>

#include "detectors/detail/lidar_template_search.hpp"
#include "detectors/detail/lidar_template_shape.hpp"
#include "petal/calibration/cloud.hpp"
#include "petal/calibration/planes.hpp"
#include "petal/run.hpp"

namespace petal {

/// The mean of a plane's finite points.
std::optional<Eigen::Vector3d> centre_of(const Plane& plane);

/// Plane patches of points on edges: the given ones, or found by RANSAC of the board's size.
class EdgePatches {
   public:
    /// `planes` may be null.
    EdgePatches(const Cloud& cloud, const Planes* planes, const PlateShape& shape, Rng& rng,
                const std::function<void()>& poll);
    const std::vector<PlateCandidate>& patches() const { return patches_; }
    /// The cloud's finite points, each once, sorted.
    const std::vector<Eigen::Vector3d>& points() const { return points_; }

   private:
    std::vector<PlateCandidate> patches_;
    std::vector<Eigen::Vector3d> points_;
};

}  // namespace petal
