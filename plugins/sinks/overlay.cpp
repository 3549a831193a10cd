// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "sinks/overlay.hpp"

#include <set>
#include <string>
#include <vector>

#include "petal/calibration/boards.hpp"
#include "petal/calibration/cloud.hpp"
#include "petal/calibration/correspondences.hpp"
#include "petal/calibration/extrinsics.hpp"
#include "petal/calibration/file_name.hpp"
#include "petal/calibration/for_pieces.hpp"
#include "petal/calibration/images.hpp"
#include "petal/calibration/picture_file.hpp"
#include "sinks/detail/overlay_canvas.hpp"
#include "sinks/detail/scene_view.hpp"

namespace petal {

namespace {

/// The picture's name, which no other of the run has: scenes may share a name, and "a_b" with "c"
/// reads as "a" with "b_c".
std::string picture_name(const std::string& scene, const std::string& camera,
                         std::set<std::string>& taken) {
    const std::string stem = file_name(scene) + "_" + file_name(camera);
    std::string name = stem;
    for (int n = 2; !taken.insert(name).second; ++n) name = stem + "_" + std::to_string(n);
    return name + ".png";
}

cv::Mat drawn_overlay(const OverlayParams& params, const Extrinsics& extrinsics,
                      const SceneView& scene, const CameraImage& image) {
    const CameraExtrinsics* solved = extrinsics_of(extrinsics, image.label);
    constexpr std::size_t kNarrow = 1000;  // px: corners' marks cover less of a wider photo
    const int automatic = image.image.getWidth() < kNarrow ? 2 : 1;
    OverlayCanvas canvas(image, params.magnification > 0 ? params.magnification : automatic);
    draw_scene(canvas, scene, scene.cloud.get(), image.label, solved,
               static_cast<std::size_t>(params.max_points), params.residual_scale);
    if (solved == nullptr) {
        canvas.draw_caption("no extrinsics for this camera: detected corners only");
    } else {
        canvas.draw_caption(std::string(to_string(extrinsics.level)) + "; residuals x" +
                            std::to_string(static_cast<int>(params.residual_scale)));
    }
    return canvas.picture();
}

}  // namespace

void Overlay::describe(Spec<Params>& s) {
    s.summary(
        "Draws detected corners, projected LiDAR points and corners, and enlarged residuals on the "
        "photo.");
    s.doc(
        "One picture a scene and camera, `stages/<id>/<scene>_<camera>.png` (what is no letter, "
        "digit, `-`, `_` or `.` is written as `%` and two hexadecimal digits; a name that is taken "
        "gets `_2`, `_3`, ...): detected corners as "
        "green crosses, "
        "LiDAR points coloured by their distance (near red, far blue), projected LiDAR corners as "
        "red "
        "circles, and from each detected corner a yellow line along its residual (measured less "
        "projected), "
        "`residual_scale` times its length. Projection uses the camera's distortion, so all of it "
        "lies on "
        "the raw photo. Without extrinsics only what was detected is drawn, and the picture says "
        "so.");
    s.gathers<Images>("images", "the photos");
    s.reads<Extrinsics>("extrinsics", "what a solver found");
    s.gathers<Cloud>("cloud", "points to project").optional();
    s.gathers<ImageBoards>("image_boards", "corners found in the photos").optional();
    s.gathers<LidarBoards>("lidar_boards", "corners found by the LiDAR").optional();
    s.gathers<Correspondences>("correspondences", "pairs, for the residuals").optional();
    s.param("magnification", &Params::magnification)
        .within(0, 8)
        .doc(
            "the picture is that many times as large as the photo; 0: twice as large where that is "
            "narrower than 1000 pixels, else as large");
    s.param("residual_scale", &Params::residual_scale)
        .unit("1")
        .within(0.0, 1000.0)
        .doc("residuals are drawn that many times as long as they are");
    s.param("max_points", &Params::max_points)
        .within(0, 100000000)
        .doc("of a larger cloud, evenly spaced points are drawn");
}

void Overlay::finish(Run& run) {
    const Extrinsics& extrinsics = run.in<Extrinsics>("extrinsics");
    const auto correspondences = run.all<Correspondences>("correspondences");
    const auto scenes = scenes_of(run, correspondences);
    struct Picture {
        std::string name;
        const SceneView* scene;
        const CameraImage* image;
        std::vector<unsigned char> bytes;
    };
    std::vector<Picture> pictures;
    std::set<std::string> taken;
    for (const auto& [number, scene] : scenes) {
        if (!scene.images) continue;
        for (const CameraImage& image : scene.images->cameras)
            pictures.push_back({picture_name(scene.name, image.label, taken), &scene, &image, {}});
    }
    for_pieces(run, pictures.size(), 1, [&](std::size_t i, std::size_t end) {
        for (; i < end; ++i) {
            Picture& picture = pictures[i];
            picture.bytes = picture_bytes(
                picture.name, drawn_overlay(params_, extrinsics, *picture.scene, *picture.image));
        }
    });
    for (const Picture& picture : pictures)
        run.save(picture.name, [&picture](const std::filesystem::path& path) {
            write_bytes(path, picture.bytes);
        });
}

}  // namespace petal
