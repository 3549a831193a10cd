// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <memory>
#include <string>
#include <vector>

#include "petal/json_value.hpp"
#include "simulation/world/texture.hpp"

namespace petal::simulation {

using SharedTexture = std::shared_ptr<const Texture>;

/// The named materials of scene files, in alphabetical order.
std::vector<std::string> material_names();
/// One of them.
SharedTexture material(const std::string& name);

/// A texture of a scene file: the name of a material, or an object with a kind
/// (docs/simulator_scenes.md).
SharedTexture read_texture(const JsonValue& node);
/// The same, `otherwise` where `node` has no such key.
SharedTexture read_texture(const JsonValue& node, const std::string& key,
                           const std::string& otherwise);

/// One number from 0 to 1 for grey and for the LiDAR alike, or {colour, reflectivity}.
Look read_look(const JsonValue& node);
/// Red, green and blue from 0 to 1, or one number for all three.
Eigen::Vector3f read_colour(const JsonValue& node);

}  // namespace petal::simulation
