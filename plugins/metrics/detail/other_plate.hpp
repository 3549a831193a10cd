// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <optional>
#include <vector>

#include "petal/calibration/cloud.hpp"
#include "petal/calibration/planes.hpp"
#include "petal/calibration/target.hpp"
#include "petal/run.hpp"

namespace petal {

/// A flat rectangle that stands free, with holes where the target has them, but of another size.
struct OtherPlate {
    double width = 0.0, height = 0.0;  ///< m: `scale` times the target's
    double range = 0.0;                ///< m, of its middle from the LiDAR
    double scale = 0.0;                ///< how much farther apart than the target's its holes are
    Eigen::Isometry3d T_lidar_board = Eigen::Isometry3d::Identity();  ///< of that pattern
    double agreement = 0.0;  ///< share of its rays that pattern explains, 0 to 1
};

/// Looks at the raw points around each plane for a plate of 0.6 to 1.6 times the target's size with
/// the target's proportions and the target's holes in proportion. The best of each plane; plates
/// found from several planes once.
std::vector<OtherPlate> other_plates(const Run& run, const Cloud& cloud, const Planes& planes,
                                     const Target& target);

}  // namespace petal
