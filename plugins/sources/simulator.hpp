// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "petal/run.hpp"
#include "petal/spec.hpp"
#include "petal/stage.hpp"
#include "simulation/scene/scene_file.hpp"

namespace petal {

struct SimulatorParams {
    std::vector<std::filesystem::path> scenes = {"indoor_floor_3m"};
    std::filesystem::path lidar;
    double duration = 0.0;
    std::string rig = "shared";
    int rig_seed = -1;
    std::string image_choice = "sharpest";
};

/// Scenes that a LiDAR and cameras would record, with the truth about them.
class SimulatorSource final : public Stage {
   public:
    using Params = SimulatorParams;
    static void describe(Spec<Params>& spec);
    explicit SimulatorSource(Params params) : params_(std::move(params)) {}
    void run(Run& run) override;

   private:
    void open(Run& run);
    std::string unique_name(const std::string& name);
    void emit(Run& run, const simulation::Scene& scene);

    Params params_;
    std::vector<simulation::SceneFile> files_;
    std::size_t captures_ = 0;  ///< of all files
    std::size_t file_ = 0;      ///< of the next scene,
    std::size_t capture_ = 0;   ///< and its place in it
    std::size_t emitted_ = 0;
    std::optional<simulation::Rig> rig_;
    std::set<std::string> names_;
};

}  // namespace petal
