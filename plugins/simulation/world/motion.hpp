// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace petal::simulation {

/// How the rig moves during the capture, from rest at the scene's time 0. World frame = LiDAR frame
/// at time 0.
struct Motion {
    Eigen::Vector3d velocity = Eigen::Vector3d::Zero();          ///< m/s
    Eigen::Vector3d angular_velocity = Eigen::Vector3d::Zero();  ///< rad/s
    double begins = 0.0;                                         ///< s: still before

    bool still() const { return velocity.isZero(0.0) && angular_velocity.isZero(0.0); }
    /// T_world_rig at `time` s. The identity while it is still.
    Eigen::Isometry3d at(double time) const {
        Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
        const double moving = time - begins;
        if (still() || moving <= 0.0) return pose;
        const double rate = angular_velocity.norm();
        if (rate > 0.0)
            pose.linear() =
                Eigen::AngleAxisd(rate * moving, angular_velocity / rate).toRotationMatrix();
        pose.translation() = velocity * moving;
        return pose;
    }
};

}  // namespace petal::simulation
