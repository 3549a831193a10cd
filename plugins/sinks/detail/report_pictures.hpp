// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <cstddef>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "petal/run.hpp"
#include "sinks/detail/report_view.hpp"
#include "sinks/detail/scene_view.hpp"

namespace petal {

/// A JPEG for the page.
struct ReportJpeg {
    int width = 0, height = 0;  ///< px
    std::vector<unsigned char> bytes;
};

/// The photo of one camera and scene with what is known drawn on it.
struct ReportPicture {
    std::string scene;
    std::string
        scene_from;  ///< JSON pointer to the scene in result.json; empty where it is not there
    std::string camera;
    bool solved = false;
    ReportJpeg photo;
    std::vector<ReportJpeg> boards;  ///< each board the camera found, enlarged
};

struct PictureSettings {
    int width = 1280;  ///< px: wider photos are shrunk
    std::size_t max_points = 20000;
    double residual_scale = 10.0;
};

/// By scene and camera. `edges`: points to draw, by frame number; the scene's cloud where there are
/// none. \throws Cancelled, Error (intrinsics that are no camera).
std::vector<ReportPicture> report_pictures(
    const Run& run, const Extrinsics& extrinsics, const std::map<std::uint64_t, SceneView>& scenes,
    const ScenePlaces& places, const std::map<std::uint64_t, std::shared_ptr<const Cloud>>& edges,
    const PictureSettings& settings);

}  // namespace petal
