// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include "petal/json_value.hpp"
#include "simulation/scene/scene_file.hpp"

namespace petal::simulation {

/// One element of "cameras" of a scene file, on its nominal mounting. \throws Error naming file and
/// key.
SceneCamera read_camera(const JsonValue& node);

/// The camera of a scene file that names none: 1280x720, f = 920 px, a little distortion, 5 cm
/// right of the LiDAR and 6 cm above it.
SceneCamera default_camera();

}  // namespace petal::simulation
