// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "sinks/detail/scene_view.hpp"

namespace petal {

std::map<std::uint64_t, SceneView> scenes_of(
    const Run& run, const std::vector<Packet<Correspondences>>& correspondences) {
    std::map<std::uint64_t, SceneView> scenes;
    const auto scene_of = [&scenes](const FrameInfo& frame) -> SceneView& {
        SceneView& scene = scenes[frame.number];
        if (scene.name.empty()) scene.name = frame.name;
        return scene;
    };
    for (const auto& packet : run.all<Images>("images"))
        scene_of(packet.frame).images = packet.value;
    for (const auto& packet : run.all<Cloud>("cloud")) scene_of(packet.frame).cloud = packet.value;
    for (const auto& packet : run.all<ImageBoards>("image_boards"))
        scene_of(packet.frame).image_boards = packet.value;
    for (const auto& packet : run.all<LidarBoards>("lidar_boards"))
        scene_of(packet.frame).lidar_boards = packet.value;
    for (const auto& packet : correspondences)
        for (const CameraPairs& pairs : packet->cameras) {
            SceneView& scene = scenes[pairs.scene];
            if (scene.name.empty()) scene.name = pairs.scene_name;
            scene.pairs.push_back(&pairs);
        }
    for (auto& [number, scene] : scenes)
        if (scene.name.empty()) scene.name = "scene_" + std::to_string(number);
    return scenes;
}

const CameraExtrinsics* extrinsics_of(const Extrinsics& extrinsics, const std::string& camera) {
    for (const CameraExtrinsics& solved : extrinsics.cameras)
        if (solved.camera == camera) return &solved;
    return nullptr;
}

void draw_scene(OverlayCanvas& canvas, const SceneView& scene, const Cloud* cloud,
                const std::string& camera, const CameraExtrinsics* solved, std::size_t max_points,
                double residual_scale, double dot) {
    if (solved != nullptr && cloud != nullptr)
        canvas.draw_cloud(*cloud, solved->T_camera_lidar, max_points, dot);
    if (scene.image_boards)
        for (const ImageBoard& board : scene.image_boards->boards)
            if (board.camera == camera) canvas.draw_detected(board.corners);
    if (solved != nullptr && scene.lidar_boards)
        for (const LidarBoard& board : scene.lidar_boards->boards)
            canvas.draw_projected(board.corners, solved->T_camera_lidar);
    if (solved != nullptr)
        for (const CameraPairs* pairs : scene.pairs)
            if (pairs->camera == camera)
                canvas.draw_residuals(pairs->pairs, solved->T_camera_lidar, residual_scale);
}

}  // namespace petal
