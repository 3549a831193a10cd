// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "metrics/reprojection.hpp"

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "metrics/detail/error_figures.hpp"
#include "metrics/detail/scene_name.hpp"
#include "petal/calibration/camera_model.hpp"
#include "petal/calibration/correspondences.hpp"
#include "petal/calibration/extrinsics.hpp"
#include "petal/calibration/metrics.hpp"

namespace petal {

void ReprojectionMetric::describe(Spec<Params>& s) {
    s.summary(
        "What the pairs miss by in the image under the extrinsics: RMS, mean, median, largest.");
    s.doc(
        R"(Projects the LiDAR point of every pair with T_camera_lidar and the model that the solver used, and
compares it with the measured raw pixel. Pairs of all cameras count together; each figure is told for every
scene and (without a scene's name) in total.

| name | what |
|---|---|
| reprojection.count | pairs |
| reprojection.rms_px, mean_px, median_px, max_px | of the 2-D distance |
| reprojection.normalised_px | the normalised error of ACSC (Cui et al., reference 25 of the letter, its Table II): \|du\| and \|dv\| each, times the corner's range over the largest range of all, averaged over the 2N values |
| reprojection.board_drift_px | the board drift of equation (16): the mean distance of the boards' corners, with plain norms, as (16) squares them yet states pixels; left out where no pair is a corner of a board |

The normalised error counts the axes apart and shrinks near corners: it is smaller than the 2-D mean, and the two
must not be compared. The letter takes the drift on scenes that the pose was not made from; told on the
solver's own pairs, as here, it is optimistic.

Pairs that do not project (behind the camera, outside its model) are left out and noted, as are cameras
without extrinsics.)");
    s.role("metric");
    s.reads<Extrinsics>("extrinsics", "the pose of each camera");
    s.gathers<Correspondences>("correspondences", "the pairs to measure, of every scene");
    s.writes<Metrics>("metrics", "figures in pixels, for each scene and in total");
}

void ReprojectionMetric::finish(Run& run) {
    const auto& extrinsics = run.in<Extrinsics>("extrinsics");
    Metrics metrics;
    std::vector<PairError> total;
    std::size_t lost = 0, unsolved = 0;
    auto scenes = run.all<Correspondences>("correspondences");
    std::stable_sort(scenes.begin(), scenes.end(),
                     [](const auto& a, const auto& b) { return a.frame.number < b.frame.number; });
    for (const auto& scene : scenes) {
        std::vector<PairError> errors;
        for (const CameraPairs& seen : scene->cameras) {
            const auto solved =
                std::find_if(extrinsics.cameras.begin(), extrinsics.cameras.end(),
                             [&](const CameraExtrinsics& camera) {
                                 return camera.camera == seen.camera && camera.lidar == seen.lidar;
                             });
            if (solved == extrinsics.cameras.end()) {
                unsolved += seen.pairs.size();
                continue;
            }
            const CameraModel model(solved->model);
            for (const PointPair& pair : seen.pairs) {
                const auto pixel = model.project(solved->T_camera_lidar * pair.lidar);
                if (!pixel || !pair.image.allFinite()) {
                    ++lost;
                    continue;
                }
                errors.push_back({pair.image - *pixel, pair.lidar.norm(), pair.board >= 0});
            }
        }
        for (Metric& figure : error_figures(errors, scene_name(scene.frame)))
            metrics.values.push_back(std::move(figure));
        total.insert(total.end(), errors.begin(), errors.end());
    }
    for (Metric& figure : error_figures(total, "")) metrics.values.push_back(std::move(figure));
    if (total.empty() || lost > 0 || unsolved > 0)
        run.note({"reprojection errors of the pairs",
                  std::to_string(total.size()) + " measured, " + std::to_string(lost) +
                      " do not project, " + std::to_string(unsolved) + " of cameras without a pose",
                  "", "see the notes of the matcher and the solver"});
    run.write("metrics", std::move(metrics));
}

}  // namespace petal
