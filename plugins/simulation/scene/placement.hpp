// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "petal/json_value.hpp"
#include "simulation/world/random.hpp"

namespace petal::simulation {

/// A number that a scene file gives, or an interval that each seed draws it from.
struct Interval {
    double low = 0.0, high = 0.0;
    double draw(Engine& engine) const { return low == high ? low : uniform(engine, low, high); }
};

/// A number, or [low, high]. \throws Error where either lies outside of [lowest, highest].
Interval read_interval(const JsonValue& node, double lowest, double highest, const char* unit);

/// Yaw about z (positive turns left), then pitch about the new y (positive: the front goes down),
/// then roll about the new x (positive: clockwise as seen from behind). Degrees.
Eigen::Matrix3d turned_deg(const Eigen::Vector3d& yaw_pitch_roll);

/// The keys yaw_deg, pitch_deg and roll_deg of an object; 0 where missing.
Eigen::Vector3d read_angles_deg(const JsonValue& node);

/// Columns: what is right, down and ahead to somebody who looks along the world's x axis. The
/// frame of a camera that looks along x, and of a board that faces it.
Eigen::Matrix3d looking_ahead();

/// A point drawn evenly from a ball.
Eigen::Vector3d draw_in_ball(Engine& engine, double radius);

}  // namespace petal::simulation
