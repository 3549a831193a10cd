// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulation/lidar/pointing.hpp"

#include <cmath>

#include "petal/calibration/angles.hpp"
#include "simulation/lidar/scan_pattern.hpp"

namespace petal::simulation {
namespace {

constexpr double kUpright = 1e-12;  // squared sine of the angle to the z axis

}  // namespace

Pointing::Pointing(const LidarDevice& device)
    : noise_(device.profile.angular_noise),
      stretch_(1.0),
      has_axis_(device.profile.pattern.kind == ScanPatternProfile::Kind::prisms) {
    const double rim = device.profile.rim();
    if (rim > 0.0) stretch_ += device.direction_error_deg / kDegrees / rim;
}

Eigen::Vector3d Pointing::stretched(const Eigen::Vector3d& direction) const {
    if (stretch_ == 1.0) return direction;
    if (has_axis_) {
        const double aside = direction.tail<2>().norm();
        if (aside == 0.0) return direction;
        const double angle = stretch_ * std::atan2(aside, direction.x());
        return off_axis(angle / aside * direction.tail<2>());
    }
    const double level = direction.head<2>().norm();
    if (level == 0.0) return direction;
    const double elevation = stretch_ * std::atan2(direction.z(), level);
    const Eigen::Vector2d ahead = std::cos(elevation) / level * direction.head<2>();
    return {ahead.x(), ahead.y(), std::sin(elevation)};
}

Eigen::Vector3d Pointing::reported(const Eigen::Vector3d& direction, Engine& engine) const {
    // One statement each: the order of two calls in one expression is the compiler's choice.
    const double aside = normal(engine, noise_);
    const double above = normal(engine, noise_);
    const Eigen::Vector3d told = stretched(direction);
    Eigen::Vector3d left = Eigen::Vector3d::UnitZ().cross(told);
    if (!(left.squaredNorm() > kUpright)) left = Eigen::Vector3d::UnitY();
    left.normalize();
    return (told + aside * left + above * told.cross(left)).normalized();
}

}  // namespace petal::simulation
