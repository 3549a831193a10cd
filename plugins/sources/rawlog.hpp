// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <mrpt/obs/CObservation.h>

#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "petal/rawlog/rawlog_read_ahead.hpp"
#include "petal/run.hpp"
#include "petal/spec.hpp"
#include "petal/stage.hpp"
#include "sources/detail/scene_builder.hpp"

namespace petal {

struct RawlogParams {
    std::vector<std::filesystem::path> files = {"${data}/scene.rawlog"};
    std::string lidar;
    std::vector<std::string> cameras;
    std::string image_choice = "sharpest";
    std::string split = "none";
    double gap = 5.0;
};

/// Scenes from rawlogs: of each, one LiDAR's points and one image of each camera.
class RawlogSource final : public Stage {
   public:
    using Params = RawlogParams;
    static void describe(Spec<Params>& spec);
    explicit RawlogSource(Params params) : params_(std::move(params)) {}
    void run(Run& run) override;

   private:
    void open(Run& run);
    /// Reads up to the scene's end. False where that is the file's end too.
    bool read_scene(Run& run, SceneBuilder& scene);
    bool begins_scene(const mrpt::obs::CObservation& observation);
    void list_rest(const Run& run);
    void check_sensors() const;
    void emit(Run& run, SceneBuilder& scene, bool whole_file);
    std::string name_scene(bool whole_file);

    Params params_;
    std::size_t next_file_ = 0;
    std::unique_ptr<RawlogReadAhead> reader_;
    SensorList sensors_;
    mrpt::obs::CObservation::Ptr held_;  ///< read already, the first of the next scene
    std::optional<double> latest_;       ///< s, the latest stamp of the scene in work
    std::size_t scenes_of_file_ = 0;
    std::set<std::string> names_;
};

}  // namespace petal
