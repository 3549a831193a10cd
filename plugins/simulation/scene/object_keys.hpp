// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <string>

#include "petal/json_value.hpp"
#include "simulation/world/surface.hpp"

// Keys that several kinds of objects have.
namespace petal::simulation {

constexpr double kFarthest = 500.0;  // m: of anything in a scene

inline double read_length(const JsonValue& node, const std::string& key, double otherwise,
                          double lowest = 0.001, double highest = kFarthest) {
    const auto value = node.find(key);
    return value ? value->number(lowest, highest, "m") : otherwise;
}

/// [x, y] on the floor.
inline Eigen::Vector2d read_place(const JsonValue& node) {
    Eigen::Vector2d place = node.at("place").vector2();
    if (place.cwiseAbs().maxCoeff() > kFarthest) node.at("place").fail("must lie within 500 m");
    return place;
}

/// What labels of points say of it.
inline Kind read_label(const JsonValue& node, Kind otherwise) {
    const auto label = node.find("label");
    if (!label) return otherwise;
    return label->choice({"background", "foreground"}) == "background" ? Kind::background
                                                                       : Kind::foreground;
}

}  // namespace petal::simulation
