// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "metrics/board_drift.hpp"

#include <algorithm>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "metrics/detail/scene_name.hpp"
#include "metrics/detail/seen_boards.hpp"
#include "petal/calibration/camera_model.hpp"
#include "petal/calibration/metrics.hpp"

namespace petal {
namespace {

void add_drift(const std::vector<double>& drifts, const std::string& scene, Metrics& metrics) {
    const auto add = [&](const char* name, double value, const char* unit) {
        metrics.values.push_back({std::string("board_drift.") + name, value, unit, scene});
    };
    add("count", static_cast<double>(drifts.size()), "1");
    if (drifts.empty()) return;
    double sum = 0.0;
    for (const double drift : drifts) sum += drift;
    add("mean_px", sum / static_cast<double>(drifts.size()), "px");
    add("max_px", *std::max_element(drifts.begin(), drifts.end()), "px");
}

}  // namespace

void BoardDrift::describe(Spec<Params>& s) {
    s.summary(
        "How far the boards' corners lie from those of the overlaid cloud: the letter's board "
        "drift.");
    s.doc(
        R"(Equation (16) of the letter, by which its Table III compares: over the n corners of the boards,

    board drift = 1/n sum |p_original - p_overlaid|

with p_original the corner in the image and p_overlaid the same corner of the LiDAR's board projected by the extrinsics, raw pixels. (16) squares the norm, yet
states pixels; here it is the plain norm.

| name | what |
|---|---|
| board_drift.count | corners |
| board_drift.mean_px | equation (16) |
| board_drift.max_px | the largest |

For every scene, and in total. The extrinsics may come from another run (`source.result`): a drift over the very pairs that made the pose is their mean
residual (`metric.reprojection` tells that too), and no matter how small it says nothing about the pose elsewhere. Corners that do not
project are left out and noted.)");
    s.role("metric");
    s.gathers<Extrinsics>("extrinsics", "the pose of each camera");
    s.gathers<Correspondences>("correspondences", "boards that both sensors see, of every scene");
    s.writes<Metrics>("metrics", "figures in pixels, for each scene and in total");
}

void BoardDrift::finish(Run& run) {
    const SeenBoards seen = seen_boards(run.all<Extrinsics>("extrinsics"),
                                        run.all<Correspondences>("correspondences"), {});
    std::map<std::uint64_t, std::pair<std::string, std::vector<double>>> scenes;
    std::vector<double> total;
    std::size_t lost = 0;
    for (const SeenBoard& board : seen.boards) {
        auto& [name, drifts] = scenes[board.scene];
        name = scene_name(FrameInfo{board.scene, board.scene_name, 0.0});
        const CameraModel model(board.model);
        for (const PointPair& corner : board.corners) {
            const auto overlaid = model.project(board.T_camera_lidar * corner.lidar);
            if (!overlaid || !corner.image.allFinite()) {
                ++lost;
                continue;
            }
            drifts.push_back((corner.image - *overlaid).norm());
            total.push_back(drifts.back());
        }
    }
    Metrics metrics;
    for (const auto& [number, scene] : scenes) add_drift(scene.second, scene.first, metrics);
    add_drift(total, "", metrics);
    if (total.empty() || lost > 0 || seen.unsolved > 0)
        run.note({"corners of boards, for equation (16)",
                  std::to_string(total.size()) + " measured, " + std::to_string(lost) +
                      " do not project, " + std::to_string(seen.unsolved) +
                      " boards of cameras without a pose, " + std::to_string(seen.single) +
                      " pairs of no board",
                  "", "see the notes of the matcher and the solver"});
    run.write("metrics", std::move(metrics));
}

}  // namespace petal
