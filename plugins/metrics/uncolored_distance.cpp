// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "metrics/uncolored_distance.hpp"

#include <algorithm>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "metrics/detail/displayed_edges.hpp"
#include "metrics/detail/scene_name.hpp"
#include "metrics/detail/seen_boards.hpp"
#include "petal/calibration/metrics.hpp"

namespace petal {
namespace {

void add_distances(const std::vector<double>& distances, const std::string& scene,
                   Metrics& metrics) {
    const auto add = [&](const char* name, double value, const char* unit) {
        metrics.values.push_back({std::string("uncolored_distance.") + name, value, unit, scene});
    };
    add("count", static_cast<double>(distances.size()), "1");
    if (distances.empty()) return;
    double sum = 0.0;
    for (const double distance : distances) sum += distance;
    add("max", *std::max_element(distances.begin(), distances.end()), "m");
    add("mean", sum / static_cast<double>(distances.size()), "m");
}

}  // namespace

void UncoloredDistance::describe(Spec<Params>& s) {
    s.summary(
        "How far the boards' edges in the coloured cloud lie from the real ones: the letter's "
        "uncolored distance.");
    s.doc(R"(Equation (17) of the letter, by which its Table III compares:

    uncolored distance = max |E_board - E_display|

with E_board an edge of the board as the LiDAR has it and E_display the same edge as the colours of the photo show it in the cloud. A pixel's colour goes to
the point of the board that its ray meets, so an edge of the photo is displayed where the rays through its ends meet the plane of the LiDAR's
corners. The distance is that of the displayed edge from the line of the real one, largest at one of its ends. (17) squares the norm, yet states metres; here it
is the plain norm.

| name | what |
|---|---|
| uncolored_distance.count | edges: sides of polygonal holes; of a target without, its corners, each with its own distance |
| uncolored_distance.max | m, equation (17) |
| uncolored_distance.mean | m |

For every scene, and in total. The extrinsics may come from another run (`source.result`); over the very pairs that made the pose it is optimistic, as the
board drift is.)");
    s.role("metric");
    s.gathers<Extrinsics>("extrinsics", "the pose of each camera");
    s.gathers<Correspondences>("correspondences", "boards that both sensors see, of every scene");
    s.gathers<LidarBoards>("lidar_boards", "the same boards, for the names of their targets");
    s.writes<Metrics>("metrics", "figures in metres, for each scene and in total");
}

void UncoloredDistance::finish(Run& run) {
    const SeenBoards seen =
        seen_boards(run.all<Extrinsics>("extrinsics"), run.all<Correspondences>("correspondences"),
                    run.all<LidarBoards>("lidar_boards"));
    std::map<std::string, std::vector<std::pair<int, int>>> sides;
    std::map<std::uint64_t, std::pair<std::string, std::vector<double>>> scenes;
    std::vector<double> total;
    std::size_t lost = 0;
    for (const SeenBoard& board : seen.boards) {
        auto& [name, distances] = scenes[board.scene];
        name = scene_name(FrameInfo{board.scene, board.scene_name, 0.0});
        auto known = sides.find(board.target);
        if (known == sides.end())
            known = sides
                        .emplace(board.target, board.target.empty()
                                                   ? std::vector<std::pair<int, int>>{}
                                                   : hole_sides(load_target(board.target)))
                        .first;
        const auto found = displayed_distances(board, known->second);
        if (!found) {
            ++lost;
            continue;
        }
        distances.insert(distances.end(), found->begin(), found->end());
        total.insert(total.end(), found->begin(), found->end());
    }
    Metrics metrics;
    for (const auto& [number, scene] : scenes) add_distances(scene.second, scene.first, metrics);
    add_distances(total, "", metrics);
    if (total.empty() || lost > 0 || seen.unsolved > 0)
        run.note({"edges of boards, for equation (17)",
                  std::to_string(total.size()) + " measured, " + std::to_string(lost) +
                      " boards that the camera's rays do not meet, " +
                      std::to_string(seen.unsolved) + " of cameras without a pose",
                  "", "see the notes of the matcher and the solver"});
    run.write("metrics", std::move(metrics));
}

}  // namespace petal
