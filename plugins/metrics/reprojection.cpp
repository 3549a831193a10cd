// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "metrics/reprojection.hpp"

#include <utility>
#include <vector>

#include "metrics/detail/error_figures.hpp"
#include "metrics/detail/pair_errors.hpp"
#include "metrics/detail/scene_name.hpp"
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
    const auto scenes =
        pair_errors(run.in<Extrinsics>("extrinsics"), run.all<Correspondences>("correspondences"));
    Metrics metrics;
    std::vector<PairError> total;
    for (const SceneErrors& scene : scenes) {
        for (Metric& figure : error_figures(scene.errors, scene_name(scene.frame)))
            metrics.values.push_back(std::move(figure));
        total.insert(total.end(), scene.errors.begin(), scene.errors.end());
    }
    for (Metric& figure : error_figures(total, "")) metrics.values.push_back(std::move(figure));
    note_unmeasured(run, scenes);
    run.write("metrics", std::move(metrics));
}

}  // namespace petal
