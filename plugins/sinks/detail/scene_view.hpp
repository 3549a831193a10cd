// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "petal/calibration/boards.hpp"
#include "petal/calibration/cloud.hpp"
#include "petal/calibration/correspondences.hpp"
#include "petal/calibration/extrinsics.hpp"
#include "petal/calibration/images.hpp"
#include "petal/run.hpp"
#include "sinks/detail/overlay_canvas.hpp"

namespace petal {

/// Everything known of one scene; null where the pipeline does not wire it.
struct SceneView {
    std::string name;
    std::shared_ptr<const Images> images;
    std::shared_ptr<const Cloud> cloud;
    std::shared_ptr<const ImageBoards> image_boards;
    std::shared_ptr<const LidarBoards> lidar_boards;
    std::vector<const CameraPairs*> pairs;
};

/// By frame number: what the ports images, cloud, image_boards and lidar_boards of a stage hold,
/// and the pairs. `correspondences` must outlive what is returned.
std::map<std::uint64_t, SceneView> scenes_of(
    const Run& run, const std::vector<Packet<Correspondences>>& correspondences);

/// Null where the camera was not solved.
const CameraExtrinsics* extrinsics_of(const Extrinsics& extrinsics, const std::string& camera);

/// Draws what is known of the scene on a camera's photo: points (at most `max_points` of `cloud`,
/// which may be null, drawn as dots of `dot` magnified pixels), detected and projected corners,
/// residuals.
void draw_scene(OverlayCanvas& canvas, const SceneView& scene, const Cloud* cloud,
                const std::string& camera, const CameraExtrinsics* solved, std::size_t max_points,
                double residual_scale, double dot = 1.0);

}  // namespace petal
