// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "sinks/colored_cloud.hpp"

#include <algorithm>
#include <cmath>

#include "petal/calibration/for_pieces.hpp"
#include "sinks/detail/colored_points.hpp"
#include "sinks/detail/judged_scene.hpp"

namespace petal {
namespace {

constexpr PointColour kGrey{110, 110, 110};

ColoredPoints colored_points(const Run& run, const JudgedScene& scene, const Occlusion& occlusion,
                             bool keep_grey) {
    ColoredPoints result;
    result.cloud = scene.cloud.get();
    std::vector<PointColours> views;
    views.reserve(scene.views.size());
    for (const JudgedScene::View& view : scene.views)
        views.emplace_back(run, *scene.cloud, view.judged, view.T_camera_lidar, occlusion);
    const std::size_t count = scene.cloud->size();
    result.colours.assign(count, kGrey);
    std::vector<std::uint8_t> has_colour(count, 0);
    constexpr std::size_t kPiece = 65536;
    for_pieces(run, count, kPiece, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i)
            for (const PointColours& view : views)
                if (const auto colour = view.of(i)) {
                    result.colours[i] = *colour;
                    has_colour[i] = 1;
                    break;  // the first camera that sees it
                }
    });
    const auto& points = *scene.cloud->points;
    const auto& xs = points.getPointsBufferRef_x();
    const auto& ys = points.getPointsBufferRef_y();
    const auto& zs = points.getPointsBufferRef_z();
    result.index.reserve(count);
    for (std::size_t i = 0; i < count; ++i) {
        result.colored += has_colour[i];
        if (has_colour[i] == 0 &&
            (!keep_grey || !std::isfinite(xs[i]) || !std::isfinite(ys[i]) || !std::isfinite(zs[i])))
            continue;
        result.index.push_back(static_cast<std::uint32_t>(i));
    }
    return result;
}

}  // namespace

void ColoredCloud::describe(Spec<Params>& s) {
    s.summary(
        "Writes the clouds in the colours of the photos, as PLY and for MRPT's SceneViewer3D.");
    s.doc(
        R"(The letter's Figures 1 and 7: each point is projected with the extrinsics and the camera's distortion, and takes the colour of the nearest pixel. One
file a scene and format, `colored_cloud/<scene>.ply` and `.3Dscene`, in the LiDAR's frame; the scene holds the axes of LiDAR and cameras too. Of several cameras
the first one that sees a point colours it.

**Hidden points keep no colour**: a point counts as hidden where another point of the same cell of the photo is nearer by more than
max(`slack`, `slack_share` times its depth); else the colours of a board would fall on the wall behind it, too. They are grey, as are points outside
of every photo, or left out (`uncolored`).

Time and memory grow linearly with the points. Colours that lie off the edges of things tell of a wrong pose, at a glance and without a number: the
number for it is `metric.uncolored_distance`.)");
    s.gathers<Images>("images", "the photos");
    s.gathers<Cloud>("cloud", "the points, unfiltered or filtered");
    s.gathers<Extrinsics>("extrinsics", "what a solver found, or source.result read");
    s.param("formats", &Params::formats)
        .choices({"ply", "3Dscene"})
        .doc("ply for most programs, 3Dscene for MRPT's SceneViewer3D");
    s.param("uncolored", &Params::uncolored)
        .choices({"grey", "drop"})
        .doc("what becomes of points that no camera sees");
    s.param("cell_px", &Params::cell_px)
        .within(0, 256)
        .doc("side of the cells in which points hide each other; 0: by the density of the points");
    s.param("slack", &Params::slack)
        .unit("m")
        .within(0.0, 10.0)
        .doc("a point so little behind the nearest of its cell is not hidden");
    s.param("slack_share", &Params::slack_share)
        .unit("1")
        .within(0.0, 1.0)
        .doc("the same as a part of its depth: floors are seen at a flat angle");
}

void ColoredCloud::finish(Run& run) {
    const auto wanted = [this](const char* format) {
        return std::find(params_.formats.begin(), params_.formats.end(), format) !=
               params_.formats.end();
    };
    const Occlusion occlusion{params_.cell_px, params_.slack, params_.slack_share};
    for (const JudgedScene& scene : judged_scenes(run)) {
        const ColoredPoints points =
            colored_points(run, scene, occlusion, params_.uncolored == "grey");
        const std::string stem = "colored_cloud/" + scene.name;
        if (wanted("ply"))
            run.output(stem + ".ply",
                       [&](const std::filesystem::path& file) { write_colored_ply(points, file); });
        run.check_cancelled();
        if (wanted("3Dscene")) {
            std::vector<SceneCamera> cameras;
            for (const JudgedScene::View& view : scene.views)
                cameras.push_back({view.image->label, view.T_camera_lidar.inverse()});
            run.output(stem + ".3Dscene", [&](const std::filesystem::path& file) {
                write_colored_scene(points, cameras, file);
            });
        }
        run.log(LogLevel::info, scene.name + ": " + std::to_string(points.colored) + " of " +
                                    std::to_string(scene.cloud->size()) + " points coloured");
    }
}

}  // namespace petal
