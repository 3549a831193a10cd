// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <Eigen/Core>

#include "simulation/lidar/lidar_simulation.hpp"
#include "simulation/world/random.hpp"

namespace petal::simulation {

/// Where a sensor believes that it points: the errors of its directions. The beam itself goes where
/// the scan pattern says.
class Pointing {
   public:
    explicit Pointing(const LidarDevice& device);

    /// Unit, LiDAR frame. The systematic error stretches the angle to the axis (prisms) or the
    /// elevation (the others); then come two random ones, about the upright and about the level
    /// axis.
    Eigen::Vector3d reported(const Eigen::Vector3d& direction, Engine& engine) const;

   private:
    Eigen::Vector3d stretched(const Eigen::Vector3d& direction) const;

    double noise_;    ///< rad, 1 sigma
    double stretch_;  ///< 1: no systematic error
    bool has_axis_;
};

}  // namespace petal::simulation
