// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <optional>

#include "petal/calibration/cloud.hpp"
#include "petal/calibration/target.hpp"
#include "petal/run.hpp"

namespace petal {

/// A figure with its 1 sigma.
struct Measured {
    double value = 0.0;
    double sigma = 0.0;
};

/// What the raw points tell of a board's shape; metres. Board frame: x right, y down.
struct BoardShape {
    /// Of the plate's surface about its plane, beyond the noise of ranges: RMS over patches of 5
    /// cm.
    double flatness = 0.0;
    double noise = 0.0;  ///< of single points across the plate, 1 sigma
    Measured bow;        ///< of the surface's quadratic: its greatest less its least height
    /// How much larger than the target's the distances of holes are, as a factor less 1: from the
    /// places of opposite sides, so that holes which look smaller by the beam's width do not count.
    std::optional<Measured> pitch_x, pitch_y;
    /// Of the outline, less what the holes tell of how far the beam's width widens the plate.
    std::optional<Measured> width, height;
};

/// From the raw cloud and a board's pose. None where fewer than 200 points lie on the plate.
std::optional<BoardShape> board_shape(const Run& run, const Cloud& cloud,
                                      const Eigen::Isometry3d& T_lidar_board, const Target& target);

}  // namespace petal
