// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "simulation/lidar/lidar_profile.hpp"

namespace petal::simulation {

/// Where each pulse goes. LiDAR frame: x forward, y left, z up. Azimuth is atan2(y, x), elevation
/// the angle above the x-y plane.
class ScanPattern {
   public:
    /// `start` s: how long the motors have run at pulse 0.
    ScanPattern(const LidarProfile& profile, double start);

    /// Unit direction of a pulse; `pulse` >= 0 counts all beams.
    Eigen::Vector3d direction(std::int64_t pulse) const;

   private:
    Eigen::Vector3d through_prisms(double time, double elevation) const;

    ScanPatternProfile pattern_;
    double points_per_second_;
    double start_;
};

/// The direction that lies `angles` rad off the x axis, towards y and towards z: their length is
/// the angle to the axis, their direction that of the plane it lies in.
Eigen::Vector3d off_axis(const Eigen::Vector2d& angles);

}  // namespace petal::simulation
