// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "metrics/detail/pair_errors.hpp"

#include <algorithm>
#include <cstdint>
#include <map>
#include <string>
#include <utility>

#include "petal/calibration/camera_model.hpp"

namespace petal {

std::vector<SceneErrors> pair_errors(const Extrinsics& extrinsics,
                                     const std::vector<Packet<Correspondences>>& packets) {
    std::map<std::uint64_t, SceneErrors> scenes;
    for (const auto& packet : packets)
        for (const CameraPairs& seen : packet->cameras) {
            SceneErrors& found = scenes[seen.scene];
            found.frame.number = seen.scene;
            if (found.frame.name.empty()) found.frame.name = seen.scene_name;
            ++found.cameras;
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
    std::vector<SceneErrors> measured;
    measured.reserve(scenes.size());
    for (auto& [number, scene] : scenes) measured.push_back(std::move(scene));
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
