// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <functional>
#include <vector>

#include "petal/json_value.hpp"
#include "simulation/scene/scene_file.hpp"
#include "simulation/world/random.hpp"

namespace petal::simulation {

/// What an object may refer to when it is put into a scene.
struct Surroundings {
    double floor = 0.0;                     ///< m: z of the ground
    const std::vector<SceneBoard>& boards;  ///< where they stand in this scene
    Engine& engine;                         ///< for all that is drawn
};

/// An object of a scene file, read and checked: it puts its surfaces into a world.
using SceneObject = std::function<void(World&, const Surroundings&)>;

/// \throws Error naming file and key. `boards`: how many the scene has.
SceneObject read_object(const JsonValue& node, std::size_t boards);

// One reader for each kind of object; docs/simulator_scenes.md tells their keys.
SceneObject read_ground(const JsonValue& node);
SceneObject read_box(const JsonValue& node);
SceneObject read_panel(const JsonValue& node);
SceneObject read_pole(const JsonValue& node);
SceneObject read_person(const JsonValue& node);
SceneObject read_wall(const JsonValue& node, std::size_t boards);
SceneObject read_room(const JsonValue& node, std::size_t boards);
SceneObject read_car(const JsonValue& node);
SceneObject read_tree(const JsonValue& node);
SceneObject read_building(const JsonValue& node);

}  // namespace petal::simulation
