// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "sinks/detail/judged_scene.hpp"

#include <set>
#include <utility>

#include "petal/calibration/estimated_focal.hpp"
#include "petal/calibration/file_name.hpp"

namespace petal {
namespace {

void add_views(JudgedScene& scene, const std::vector<Packet<Extrinsics>>& extrinsics) {
    for (const CameraImage& image : scene.images->cameras)
        for (const auto& packet : extrinsics)
            for (const CameraExtrinsics& solved : packet->cameras)
                if (solved.camera == image.label && solved.lidar == scene.cloud->sensor_label &&
                    solved.T_camera_lidar.matrix().allFinite()) {
                    CameraImage judged = image;
                    judged.image = image.image.makeShallowCopy();
                    judged.camera = with_estimated_focal(image.camera, solved);
                    scene.views.push_back({&image, std::move(judged), solved.T_camera_lidar});
                }
}

}  // namespace

std::vector<JudgedScene> judged_scenes(Run& run) {
    const auto extrinsics = run.all<Extrinsics>("extrinsics");
    std::map<std::uint64_t, JudgedScene> by_frame;
    for (const auto& packet : run.all<Images>("images")) {
        by_frame[packet.frame.number].images = packet.value;
        by_frame[packet.frame.number].name = packet.frame.name;
    }
    for (const auto& packet : run.all<Cloud>("cloud")) {
        by_frame[packet.frame.number].cloud = packet.value;
        by_frame[packet.frame.number].name = packet.frame.name;
    }
    std::vector<JudgedScene> scenes;
    std::set<std::string> taken;
    for (auto& [number, scene] : by_frame) {
        if (!scene.cloud || !scene.images || scene.cloud->size() == 0) continue;
        add_views(scene, extrinsics);
        if (scene.views.empty()) continue;
        const std::string stem =
            scene.name.empty() ? "scene_" + std::to_string(number) : file_name(scene.name);
        scene.name = stem;
        for (int n = 2; !taken.insert(scene.name).second; ++n)
            scene.name = stem + "_" + std::to_string(n);
        scenes.push_back(std::move(scene));
    }
    if (scenes.empty())
        run.note({"scenes with points and a photo of a camera whose pose is known",
                  std::to_string(by_frame.size()) + " scenes, none of them with all three", "",
                  "see whether the camera was solved, and whether the labels agree"});
    return scenes;
}

}  // namespace petal
