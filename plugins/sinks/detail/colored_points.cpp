// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "sinks/detail/colored_points.hpp"

#include <mrpt/opengl/COpenGLScene.h>
#include <mrpt/opengl/CPointCloudColoured.h>
#include <mrpt/opengl/stock_objects.h>

#include <cstring>

#include "petal/error.hpp"
#include "petal/output.hpp"

namespace petal {

void write_colored_ply(const ColoredPoints& points, const std::filesystem::path& file) {
    const auto& xs = points.cloud->points->getPointsBufferRef_x();
    const auto& ys = points.cloud->points->getPointsBufferRef_y();
    const auto& zs = points.cloud->points->getPointsBufferRef_z();
    std::string text =
        "ply\nformat binary_little_endian 1.0\ncomment metres, the LiDAR's frame\nelement vertex " +
        std::to_string(points.index.size()) +
        "\nproperty float x\nproperty float y\nproperty float z\nproperty uchar red\n"
        "property uchar green\nproperty uchar blue\nend_header\n";
    constexpr std::size_t kRecord = 3 * sizeof(float) + 3;
    std::size_t at = text.size();
    text.resize(at + kRecord * points.index.size());
    for (const std::uint32_t i : points.index) {
        const float place[3] = {xs[i], ys[i], zs[i]};
        std::memcpy(&text[at], place, sizeof place);
        const PointColour& colour = points.colours[i];
        const unsigned char rgb[3] = {colour.red, colour.green, colour.blue};
        std::memcpy(&text[at + sizeof place], rgb, sizeof rgb);
        at += kRecord;
    }
    write_file(file, text);
}

void write_colored_scene(const ColoredPoints& points, const std::vector<SceneCamera>& cameras,
                         const std::filesystem::path& file) {
    const auto& xs = points.cloud->points->getPointsBufferRef_x();
    const auto& ys = points.cloud->points->getPointsBufferRef_y();
    const auto& zs = points.cloud->points->getPointsBufferRef_z();
    auto cloud = mrpt::opengl::CPointCloudColoured::Create();
    cloud->setName("cloud");
    cloud->setPointSize(2.0F);
    cloud->resize(points.index.size());
    for (std::size_t k = 0; k < points.index.size(); ++k) {
        const std::uint32_t i = points.index[k];
        cloud->setPoint_fast(k, xs[i], ys[i], zs[i]);
        const PointColour& colour = points.colours[i];
        cloud->setPointColor_u8_fast(k, colour.red, colour.green, colour.blue);
    }
    cloud->markAllPointsAsNew();
    mrpt::opengl::COpenGLScene scene;
    scene.insert(cloud);
    const auto add_axes = [&scene](const std::string& label, const Eigen::Isometry3d& pose) {
        auto axes = mrpt::opengl::stock_objects::CornerXYZSimple(0.3F, 3.0F);
        axes->setName(label);
        axes->enableShowName();
        axes->setPose(
            mrpt::poses::CPose3D(mrpt::math::CMatrixDouble44(Eigen::Matrix4d(pose.matrix()))));
        scene.insert(axes);
    };
    add_axes(points.cloud->sensor_label, Eigen::Isometry3d::Identity());
    for (const SceneCamera& camera : cameras) add_axes(camera.label, camera.T_lidar_camera);
    if (!scene.saveToFile(file.string()))
        throw Error("cannot write " + file.string() + "; is the disk full?");
}

}  // namespace petal
