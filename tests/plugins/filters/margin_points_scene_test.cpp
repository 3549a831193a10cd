// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

// The margin filter on a simulated board before a wall, whose points are labelled and whose edges
// are known.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "filters/margin_points.hpp"
#include "petal/calibration/cloud.hpp"
#include "petal/calibration/polygon.hpp"
#include "petal/testing/stage_harness.hpp"
#include "plugins/simulation/camera_worlds.hpp"
#include "simulation/lidar/lidar_simulation.hpp"
#include "simulation/scene/scene_file.hpp"

namespace petal {
namespace {

constexpr std::uint8_t kBoardLabel = 1, kVacantLabel = 2;

struct LabelledScene {
    Cloud cloud;
    std::vector<std::uint8_t> labels;
    std::vector<simulation::SceneBoard> boards;

    double share(std::uint8_t label, const std::vector<std::uint32_t>& points) const {
        const auto count = std::count_if(points.begin(), points.end(),
                                         [&](std::uint32_t i) { return labels[i] == label; });
        return static_cast<double>(count) / static_cast<double>(points.size());
    }
    /// Where a point, moved onto the board's plane, lies there.
    Eigen::Vector2d on_board(std::uint32_t i) const {
        float x, y, z;
        cloud.points->getPoint(i, x, y, z);
        const Eigen::Vector3d there =
            boards.front().T_world_board.inverse() * Eigen::Vector3f(x, y, z).cast<double>();
        return there.head<2>();
    }
    /// From there to the nearest side of its outline or of a hole.
    double to_edge(std::uint32_t i) const {
        const Target& target = boards.front().target;
        double nearest = distance_to_polygon(target.outline, on_board(i));
        for (const auto& hole : target.holes)
            nearest = std::min(nearest, distance_to_polygon(hole, on_board(i)));
        return nearest;
    }
};

LabelledScene simulated(std::uint64_t seed, double duration) {
    const auto file = simulation::SceneFile::load(PETAL_SOURCE_DIR "/tests/data/small_scene.json");
    Rng rng(seed);
    const simulation::Rig rig = file.make_rig("", rng);
    const simulation::Scene scene = file.make_scene(0, rng);
    LabelledScene result;
    result.boards = scene.boards;
    auto points = std::make_shared<mrpt::maps::CPointsMapXYZI>();
    for (const auto& message :
         simulate_lidar(scene.world, rig.lidar, scene.motion, duration, seed, testing::BareRun())) {
        for (std::size_t i = 0; i < message.x.size(); ++i)
            points->insertPointFast(message.x[i], message.y[i], message.z[i]);
        result.labels.insert(result.labels.end(), message.label.begin(), message.label.end());
    }
    points->mark_as_modified();
    result.cloud.points = std::move(points);
    return result;
}

TEST(MarginPointsScene, OfABoardItsEdgesStayAndVacantPointsGo) {
    for (const std::uint64_t seed : {1U, 2U}) {
        const LabelledScene scene = simulated(seed, 2.0);
        auto stage = testing::StageHarness::of<MarginPoints>("filter.margin_points");
        stage.give<Cloud>("cloud", scene.cloud);
        stage.fire();
        const auto& kept = stage.out<Cloud>("cloud").scene_index;
        ASSERT_GT(kept.size(), 500U);
        // Half the diagonal of a cell of 1.5 beams (0.42 deg) and half of the beam (0.28 deg), on
        // a board 1.4 m off.
        const double reach = 1.45 * (0.42 * std::sqrt(0.5) + 0.14) * M_PI / 180.0;
        std::size_t board = 0, near = 0;
        for (const std::uint32_t i : kept) {
            if (scene.labels[i] != kBoardLabel) continue;
            ++board;
            near += scene.to_edge(i) <= reach;
        }
        EXPECT_GT(board, kept.size() / 2);
        EXPECT_GE(static_cast<double>(near), 0.9 * static_cast<double>(board));
        EXPECT_LE(scene.share(kVacantLabel, kept), 0.06);  // what is asked behind the plane stage
        // All of the edge is there: each side of a hole has its points.
        for (const auto& hole : scene.boards.front().target.holes)
            for (std::size_t side = 0; side < hole.size(); ++side) {
                const std::vector<Eigen::Vector2d> line = {hole[side],
                                                           hole[(side + 1) % hole.size()]};
                const auto count = std::count_if(kept.begin(), kept.end(), [&](std::uint32_t i) {
                    return scene.labels[i] == kBoardLabel &&
                           distance_to_polygon(line, scene.on_board(i)) <= reach;
                });
                EXPECT_GE(count, 10) << "seed " << seed;
            }
    }
}

}  // namespace
}  // namespace petal
