// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "petal/json_value.hpp"
#include "simulation/scene/board_placement.hpp"
#include "simulation/scene/rig_plan.hpp"
#include "simulation/scene/scene_file.hpp"
#include "simulation/scene/scene_object.hpp"

namespace petal::simulation {

/// One still capture of a scene file, read and checked: what stands where, and how it may vary.
class CapturePlan {
   public:
    /// `capture`: one element of "captures", whose keys go before those of the whole `scene`; none
    /// where the file has no captures. \throws Error naming file and key.
    CapturePlan(const JsonValue& scene, const std::optional<JsonValue>& capture, std::string name);

    /// Draws boards until every one lies in an image of `rig`, for a bounded number of times.
    /// \throws Error naming the board and by how much it misses.
    /// `boards_seed`: see Rig.
    Scene draw(const RigPlan& rig, Engine& engine, std::uint64_t boards_seed) const;

    std::vector<std::filesystem::path> target_files() const;

   private:
    void read_light(const JsonValue& light);
    void read_motion(const JsonValue& motion);

    std::string name_;
    double floor_ = -1.0;  ///< m: z of the ground
    double duration_ = 10.0;
    int images_ = 3;
    Light light_;
    Motion motion_;
    std::vector<BoardPlacement> boards_;
    std::vector<SceneObject> objects_;
};

}  // namespace petal::simulation
