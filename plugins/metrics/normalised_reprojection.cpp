// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "metrics/normalised_reprojection.hpp"

#include <algorithm>
#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "metrics/detail/pair_errors.hpp"
#include "metrics/detail/scene_name.hpp"
#include "metrics/detail/table_two.hpp"
#include "petal/calibration/metrics.hpp"
#include "petal/calibration/truth.hpp"

namespace petal {
namespace {

std::size_t corners_of(const Truth& truth) {
    std::size_t corners = 0;
    for (const Truth::Board& board : truth.boards)
        corners += std::max(board.corners_lidar.size(), board.corners_image.size());
    return corners;
}

/// For each frame the corners of the boards that stand there; left out where none is known of.
/// Frames that no camera is told of join `scenes`: they have failed as a whole.
std::map<std::uint64_t, std::size_t> standing_corners(Run& run, std::vector<SceneErrors>& scenes) {
    std::map<std::uint64_t, std::size_t> corners;
    if (!run.wired("truth")) return corners;
    for (const auto& truth : run.all<Truth>("truth")) {
        const std::size_t count = corners_of(*truth);
        if (count == 0) continue;
        corners.emplace(truth.frame.number, count);
        const auto at = std::lower_bound(
            scenes.begin(), scenes.end(), truth.frame.number,
            [](const SceneErrors& scene, std::uint64_t n) { return scene.frame.number < n; });
        if (at != scenes.end() && at->frame.number == truth.frame.number) continue;
        SceneErrors failed;
        failed.frame = truth.frame;
        scenes.insert(at, std::move(failed));
    }
    return corners;
}

}  // namespace

void NormalisedReprojectionMetric::describe(Spec<Params>& s) {
    s.summary(
        "Table II of the letter: the normalised reprojection error, and its shares below 1, 5 and "
        "10 px.");
    s.doc(
        R"(The normalised error of ACSC (Cui et al., reference 25 of the letter) takes \|du\| and \|dv\| of each corner by
itself, times the corner's range over the largest range of all: 2N values for N corners. Each figure is told for every scene (with the
scene's own largest range) and (without a scene's name) in total.

| name | what |
|---|---|
| normalised_reprojection.count | corners measured, of all cameras |
| normalised_reprojection.expected | corners that were to be found |
| normalised_reprojection.largest_range | the largest range of a measured corner, in metres: other ranges give other figures for the same pixels |
| normalised_reprojection.mean_px, deviation_px | mean and standard deviation of the 2N values |
| normalised_reprojection.below_1px_share, below_5px_share, below_10px_share | how many of the values are smaller, of 2 x expected |
| normalised_reprojection.norm_mean_px, norm_deviation_px, norm_below_1px_share, ... | the same of the 2-D distance, times the same factor: N values, of expected |

Table II states for the letter's method 1.88 px, 44.64 %, 90.18 % and 99.11 %. It does not say what became of
boards that were not found. Here a corner that was to be found and was not counts as beyond 10 px: it lowers the
shares, and a method gains nothing by finding the easy boards only. The means are of the corners that were measured.

How many corners were to be found: `expected_corners` for each scene and camera where that is set; else all those of the boards in
`truth`, for each camera, whether they stand in its view or not; else, for real data, only the pairs that there are, and a
note says so. Pairs that do not project, and those of a camera without a pose, were to be found in any case.

A small figure is no proof of a good pose: see metric.truth.)");
    s.role("metric");
    s.reads<Extrinsics>("extrinsics", "the pose of each camera");
    s.gathers<Correspondences>("correspondences", "the pairs to measure, of every scene");
    s.gathers<Truth>("truth", "the boards that stand in every scene").optional();
    s.writes<Metrics>("metrics", "Table II, for each scene and in total");
    s.param("expected_corners", &Params::expected_corners)
        .within(0, 100000)
        .doc("corners to be found for each scene and camera; 0: those of the truth's boards");
}

void NormalisedReprojectionMetric::finish(Run& run) {
    auto scenes =
        pair_errors(run.in<Extrinsics>("extrinsics"), run.all<Correspondences>("correspondences"));
    const auto standing = standing_corners(run, scenes);
    Metrics metrics;
    std::vector<PairError> total;
    std::vector<std::string> unknown;
    std::size_t total_expected = 0;
    for (const SceneErrors& scene : scenes) {
        const std::string name = scene_name(scene.frame);
        const auto known = standing.find(scene.frame.number);
        auto corners = static_cast<std::size_t>(params_.expected_corners);
        if (corners == 0 && known != standing.end()) corners = known->second;
        if (corners == 0) unknown.push_back(name);
        // A scene in which not even a camera was found has failed as a whole.
        const std::size_t views = std::max<std::size_t>(scene.cameras, 1);
        const std::size_t expected = std::max(corners * views, scene.pairs());
        for (Metric& figure : table_two_figures(scene.errors, expected, name))
            metrics.values.push_back(std::move(figure));
        total.insert(total.end(), scene.errors.begin(), scene.errors.end());
        total_expected += expected;
    }
    for (Metric& figure : table_two_figures(total, total_expected, ""))
        metrics.values.push_back(std::move(figure));
    note_unmeasured(run, scenes);
    if (!unknown.empty())
        run.note({"corners that were to be found",
                  "not known for " + std::to_string(unknown.size()) + " of " +
                      std::to_string(scenes.size()) +
                      " scenes, whose missing boards do not count: " + listed(unknown),
                  "", "wire the truth of simulated scenes, or set expected_corners"});
    run.write("metrics", std::move(metrics));
}

}  // namespace petal
