// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "sinks/projection.hpp"

#include <string>

#include "petal/calibration/file_name.hpp"
#include "petal/calibration/picture_file.hpp"
#include "sinks/detail/judged_scene.hpp"
#include "sinks/detail/range_picture.hpp"

namespace petal {

void Projection::describe(Spec<Params>& s) {
    s.summary("Draws the points of the cloud over the photo, coloured by range.");
    s.doc(
        R"(The letter's Figure 9, left: all points that the camera sees, projected with the extrinsics and the camera's distortion over the photo in grey. Near points
are red, far ones blue, by the logarithm of their distance from the LiDAR; a scale in metres stands below. Nearer points cover farther ones, and those that are
hidden behind a near surface are left out (as in `sink.colored_cloud`), so an edge in the points can be held against the same edge in the photo.

One picture a scene and camera, `projection/<scene>_<camera>.png`.)");
    s.gathers<Images>("images", "the photos");
    s.gathers<Cloud>("cloud", "the points, unfiltered or filtered");
    s.gathers<Extrinsics>("extrinsics", "what a solver found, or source.result read");
    s.param("point_px", &Params::point_px).within(1, 32).doc("side of a point's square");
    s.param("max_points", &Params::max_points)
        .within(1, 100000000)
        .doc(
            "of a larger cloud, about so many evenly spaced points are drawn, so that the photo "
            "shows");
    s.param("min_range", &Params::min_range)
        .unit("m")
        .within(0.0, 1000.0)
        .doc("red, with max_range; of points nearer too");
    s.param("max_range", &Params::max_range)
        .unit("m")
        .within(0.0, 1000.0)
        .doc("blue; 0: both ends by the points, all but 2 % at either end");
    s.param("photo_brightness", &Params::photo_brightness)
        .unit("1")
        .within(0.0, 1.0)
        .doc("of the photo beneath");
    s.check([](const Params& p) {
        return p.max_range > 0.0 && p.min_range >= p.max_range ? "min_range must be below max_range"
                                                               : "";
    });
}

void Projection::finish(Run& run) {
    const RangePictureStyle style{params_.point_px, static_cast<std::size_t>(params_.max_points),
                                  params_.min_range, params_.max_range, params_.photo_brightness};
    for (const JudgedScene& scene : judged_scenes(run))
        for (const JudgedScene::View& view : scene.views) {
            run.check_cancelled();
            const PointColours seen(run, *scene.cloud, view.judged, view.T_camera_lidar);
            const cv::Mat picture =
                range_picture(view.judged.image.asCvMat<cv::Mat>(mrpt::img::SHALLOW_COPY),
                              *scene.cloud, seen, style);
            run.output("projection/" + scene.name + "_" + file_name(view.image->label) + ".png",
                       [&](const std::filesystem::path& file) { write_picture(file, picture); });
        }
}

}  // namespace petal
