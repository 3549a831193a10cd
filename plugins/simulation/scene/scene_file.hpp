// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "petal/calibration/target.hpp"
#include "petal/run.hpp"
#include "simulation/camera/camera_simulation.hpp"
#include "simulation/lidar/lidar_simulation.hpp"

namespace petal::simulation {

struct SceneBoard {
    Target target;
    Eigen::Isometry3d T_world_board;  ///< world frame = LiDAR frame at time 0
};

struct SceneCamera {
    CameraDevice device;
    Eigen::Isometry3d T_camera_lidar;
    double focal_error = 0.0;  ///< of 1: by how much the recorded focal lengths are too long
    Eigen::Vector2d principal_point_error_px = Eigen::Vector2d::Zero();  ///< likewise

    /// What a recorder would know of the camera: its intrinsics with these errors.
    mrpt::img::TCamera recorded_intrinsics() const;
};

/// The sensors on their mounting and how the boards are cut: what stays the same from scene to
/// scene.
struct Rig {
    std::string lidar_label = "LIDAR";
    LidarDevice lidar;
    std::vector<SceneCamera> cameras;
    std::uint64_t boards_seed = 0;  ///< of the errors of boards whose "cut_sigma" is not 0
};

/// One still capture, ready to be simulated.
struct Scene {
    std::string name;
    World world;
    Light light;
    std::vector<SceneBoard> boards;
    Motion motion;
    double duration = 10.0;  ///< s
    int images = 3;          ///< of each camera, spread over the duration
};

/// A scene file (datasets/scenes): what stands where, and how it may vary from seed to seed.
/// The file holds one capture or several; docs/simulator_scenes.md tells its keys.
class SceneFile {
   public:
    /// `name_or_path`: a scene that petal ships, or a JSON file. \throws Error naming file, key and
    /// what was expected.
    static SceneFile load(const std::filesystem::path& name_or_path);
    ~SceneFile();
    SceneFile(SceneFile&&) noexcept;
    SceneFile& operator=(SceneFile&&) noexcept;

    const std::string& name() const;
    /// Every file that it was read from (itself, what it is based on, targets, the sensor's
    /// profile).
    const std::vector<std::filesystem::path>& files() const;
    std::size_t captures() const;

    /// A rig within the file's tolerances around its nominal mounting. `lidar` names another sensor
    /// profile than the file's; empty: the file's.
    Rig make_rig(const std::filesystem::path& lidar, Rng& rng) const;
    /// Capture `index` with its random placement. The boards of captures with one `boards_seed` are
    /// the same ones.
    Scene make_scene(std::size_t index, Rng& rng, std::uint64_t boards_seed = 0) const;

   private:
    SceneFile();
    struct Content;
    std::unique_ptr<Content> content_;
};

}  // namespace petal::simulation
