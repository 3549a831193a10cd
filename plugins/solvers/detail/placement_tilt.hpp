// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

namespace petal {

/// The axis that boards are turned about least against each other.
struct PlacementTilt {
    double spread = 0.0;                              ///< rad, RMS about their mean
    Eigen::Vector3d axis = Eigen::Vector3d::UnitX();  ///< unit, in the frame of the normals
};

/// Of boards with these unit normals. None for fewer than two, or where the normals cancel out.
std::optional<PlacementTilt> least_tilt(const std::vector<Eigen::Vector3d>& normals);

/// Words for a spread below `least_deg`, of normals in the camera frame: boards that differ by yaw
/// alone, say, cannot show an error in pitch that all of them share, however small the noise.
std::optional<std::string> tilt_doubt(const PlacementTilt& tilt, double least_deg);

}  // namespace petal
