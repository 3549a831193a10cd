// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "metrics/detail/pair_errors.hpp"

#include <algorithm>
#include <string>
#include <utility>

#include "petal/calibration/camera_model.hpp"

namespace petal {

std::vector<SceneErrors> pair_errors(const Extrinsics& extrinsics,
                                     std::vector<Packet<Correspondences>> scenes) {
    std::stable_sort(scenes.begin(), scenes.end(),
                     [](const auto& a, const auto& b) { return a.frame.number < b.frame.number; });
    std::vector<SceneErrors> measured;
    for (const auto& scene : scenes) {
        SceneErrors found;
        found.frame = scene.frame;
        found.cameras = scene->cameras.size();
        for (const CameraPairs& seen : scene->cameras) {
            const auto solved =
                std::find_if(extrinsics.cameras.begin(), extrinsics.cameras.end(),
                             [&](const CameraExtrinsics& camera) {
                                 return camera.camera == seen.camera && camera.lidar == seen.lidar;
                             });
            if (solved == extrinsics.cameras.end()) {
                found.unsolved += seen.pairs.size();
                continue;
            }
            const CameraModel model(solved->model);
            for (const PointPair& pair : seen.pairs) {
                const auto pixel = model.project(solved->T_camera_lidar * pair.lidar);
                if (!pixel || !pair.image.allFinite()) {
                    ++found.lost;
                    continue;
                }
                found.errors.push_back({pair.image - *pixel, pair.lidar.norm(), pair.board >= 0});
            }
        }
        measured.push_back(std::move(found));
    }
    return measured;
}

void note_unmeasured(Run& run, const std::vector<SceneErrors>& scenes) {
    std::size_t measured = 0, lost = 0, unsolved = 0;
    for (const SceneErrors& scene : scenes) {
        measured += scene.errors.size();
        lost += scene.lost;
        unsolved += scene.unsolved;
    }
    if (measured > 0 && lost == 0 && unsolved == 0) return;
    run.note({"reprojection errors of the pairs",
              std::to_string(measured) + " measured, " + std::to_string(lost) +
                  " do not project, " + std::to_string(unsolved) + " of cameras without a pose",
              "", "see the notes of the matcher and the solver"});
}

}  // namespace petal
