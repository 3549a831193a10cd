// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <filesystem>
#include <vector>

#include "petal/json_value.hpp"
#include "simulation/scene/scene_file.hpp"
#include "simulation/world/random.hpp"

namespace petal::simulation {

/// The sensors of a scene file on their nominal mounting, and how far a rig may differ from it.
class RigPlan {
   public:
    /// Reads the keys lidar, cameras and rig of a whole scene. \throws Error naming file and key.
    explicit RigPlan(const JsonValue& scene);

    /// `lidar`: another profile than the file's; empty: the file's.
    Rig draw(const std::filesystem::path& lidar, Engine& engine) const;

    /// How far inside a camera's image the board lies, px, whatever rig is drawn: that of the
    /// camera that sees most of it. Below 0 where some rig misses part of it.
    double image_margin(const SceneBoard& board) const;

    const std::filesystem::path& profile_file() const { return profile_file_; }
    double rotation_deg() const { return rotation_deg_; }
    double translation() const { return translation_; }

   private:
    void read_lidar(const JsonValue& lidar);

    std::filesystem::path profile_file_;
    LidarProfile profile_;
    double range_offset_sigma_ = -1.0;  ///< below 0: the profile's
    double direction_error_deg_ = 0.0;
    std::vector<SceneCamera> cameras_;
    double rotation_deg_ = 5.0;  ///< the most, about any axis
    double translation_ = 0.2;   ///< m: the most, in any direction
};

}  // namespace petal::simulation
