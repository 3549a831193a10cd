// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include <vector>

#include "simulation/camera/camera_simulation.hpp"
#include "simulation/camera/lens.hpp"
#include "simulation/camera/picture.hpp"
#include "simulation/camera/pixel_rays.hpp"
#include "simulation/camera/rows.hpp"
#include "simulation/camera/shading.hpp"

namespace petal::simulation {

cv::Mat render(const World& world, const Light& light, const CameraDevice& camera,
               const Eigen::Isometry3d& T_world_camera, const Run& run) {
    // Seen beyond the rim as far as the blur reaches, which therefore needs no rule there.
    const Blur blur(camera.blur_px);
    const int margin = blur.reach();
    const PixelRays rays(CameraModel(camera.intrinsics), margin, run);
    const Shading shading(world, light, T_world_camera);
    const Picture picture(rays, shading, run);
    const Vignetting vignetting(rays, margin, camera.vignetting);

    cv::Mat means(rays.rows(), rays.columns(), CV_32FC3);
    std::vector<std::vector<Blur::Divided>> divided(static_cast<std::size_t>(rays.rows()));
    for_rows(run, rays.rows(), [&](int row) {
        auto* const values = means.ptr<cv::Vec3f>(row);
        for (int column = 0; column < rays.columns(); ++column) {
            Pixel pixel = picture.pixel(column, row);
            const float left = vignetting.left(column, row);
            const Eigen::Vector3f mean = left * pixel.mean;
            values[column] = {mean.x(), mean.y(), mean.z()};
            if (!pixel.divided || margin == 0) continue;
            for (Eigen::Vector3f& cell : pixel.cells) cell *= left;
            divided[static_cast<std::size_t>(row)].push_back({column, pixel.cells});
        }
    });
    const cv::Rect image(margin, margin, means.cols - 2 * margin, means.rows - 2 * margin);
    return blur.of(means, divided, run)(image).clone();
}

}  // namespace petal::simulation
