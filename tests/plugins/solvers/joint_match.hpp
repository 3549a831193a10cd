// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "petal/testing/stage_harness.hpp"
#include "plugins/solvers/made_rig.hpp"
#include "solvers/board_matcher.hpp"

namespace petal::testing {

using Scenes = std::vector<MadeRig::Seen>;

/// One board a scene, the LiDAR's corner order turned at will.
inline Scenes one_board_each(MadeRig& rig, const std::vector<Placement>& places) {
    Scenes scenes;
    for (const Placement& place : places) {
        scenes.push_back(rig.scene());
        rig.add(scenes.back(), place, true, true, static_cast<int>(rig.random()() % 4));
    }
    return scenes;
}

inline StageHarness matcher_of(const Scenes& scenes, bool priors) {
    auto stage = StageHarness::of<BoardMatcher>("solver.board_matcher");
    stage.set("upright", priors).set("use_max_baseline", priors);
    for (std::size_t i = 0; i < scenes.size(); ++i) {
        const std::string name = "place_" + std::to_string(i);
        stage.give<LidarBoards>("lidar", scenes[i].lidar, name);
        stage.give<ImageBoards>("image", scenes[i].image, name);
    }
    return stage;
}

inline std::vector<CameraPairs> match_jointly(const Scenes& scenes, bool priors = false) {
    auto stage = matcher_of(scenes, priors);
    stage.fire();
    return stage.out<Correspondences>("correspondences").cameras;
}

inline std::size_t boards_in(const std::vector<CameraPairs>& cameras) {
    std::size_t boards = 0;
    for (const CameraPairs& camera : cameras) boards += camera.boards.size();
    return boards;
}

}  // namespace petal::testing
