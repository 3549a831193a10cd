// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulation/lidar/scan_pattern.hpp"

#include <cmath>

namespace petal::simulation {
namespace {

constexpr double kFullTurn = 6.283185307179586476925;

/// The part of a turn that has been made since the last whole one.
double phase(double turns) {
    return turns - std::floor(turns);
}

}  // namespace

Eigen::Vector3d off_axis(const Eigen::Vector2d& angles) {
    const double angle = angles.norm();
    if (angle == 0.0) return Eigen::Vector3d::UnitX();
    const Eigen::Vector2d aside = angles * (std::sin(angle) / angle);
    return {std::cos(angle), aside.x(), aside.y()};
}

ScanPattern::ScanPattern(const LidarProfile& profile, double start)
    : pattern_(profile.pattern), points_per_second_(profile.points_per_second), start_(start) {}

/// A thin prism deflects by a constant angle towards its thick end; two of them add up.
Eigen::Vector3d ScanPattern::through_prisms(double time, double elevation) const {
    Eigen::Vector2d angles(0.0, elevation);
    for (std::size_t i = 0; i < pattern_.deflections.size(); ++i) {
        const double turned = kFullTurn * phase(pattern_.rates[i] * time);
        angles += pattern_.deflections[i] * Eigen::Vector2d(std::cos(turned), std::sin(turned));
    }
    return off_axis(angles);
}

Eigen::Vector3d ScanPattern::direction(std::int64_t pulse) const {
    const double time = start_ + static_cast<double>(pulse) / points_per_second_;
    const std::size_t beams = pattern_.elevations.size();
    double elevation =
        beams == 0 ? 0.0 : pattern_.elevations[static_cast<std::size_t>(pulse) % beams];
    if (pattern_.kind == ScanPatternProfile::Kind::prisms) return through_prisms(time, elevation);
    if (pattern_.kind == ScanPatternProfile::Kind::nodding) {
        const double up = 1.0 - std::abs(2.0 * phase(pattern_.swing * time) - 1.0);
        elevation =
            pattern_.elevation_low + up * (pattern_.elevation_high - pattern_.elevation_low);
    }
    const double azimuth = kFullTurn * phase(pattern_.rotation * time);
    return {std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth),
            std::sin(elevation)};
}

}  // namespace petal::simulation
