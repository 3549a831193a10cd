// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "sources/detail/simulated_packets.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "petal/calibration/camera_model.hpp"
#include "petal/error.hpp"
#include "simulation/camera/camera_simulation.hpp"
#include "simulation/lidar/lidar_simulation.hpp"
#include "sources/detail/sharpness.hpp"

namespace petal {
namespace {

using simulation::LidarMessage;
using simulation::Rig;
using simulation::Scene;
using simulation::SceneCamera;

constexpr double kFirstScene = 1767225600.0;  // s since the epoch: 2026-01-01, 0 h UTC
constexpr double kBetweenScenes = 60.0;       // s, from the end of one to the next minute

double scene_begin(const Scene& scene, std::size_t number) {
    const double minutes = std::ceil(scene.duration / kBetweenScenes) + 1.0;
    return kFirstScene + kBetweenScenes * minutes * static_cast<double>(number);
}

Cloud cloud_of(const std::vector<LidarMessage>& messages, const std::string& label, double begin) {
    std::size_t size = 0;
    for (const LidarMessage& message : messages) size += message.x.size();
    auto points = std::make_shared<mrpt::maps::CPointsMapXYZI>();
    points->reserve(size);
    Cloud cloud;
    for (const LidarMessage& message : messages) {
        cloud.parts.push_back({points->size(), mrpt::Clock::fromDouble(begin + message.stamp)});
        for (std::size_t i = 0; i < message.x.size(); ++i) {
            points->insertPointFast(message.x[i], message.y[i], message.z[i]);
            points->setPointIntensity(points->size() - 1, message.intensity[i]);
        }
    }
    points->mark_as_modified();
    cloud.points = std::move(points);
    cloud.sensor_label = label;
    return cloud;
}

/// All images of one camera, in the order in which they are taken: in the middle of equal parts of
/// the capture.
std::vector<CameraImage> images_of(const SceneCamera& camera, const Scene& scene, double begin,
                                   std::uint64_t seed, const Run& run) {
    std::vector<CameraImage> images;
    cv::Mat radiance;
    for (int i = 0; i < scene.images; ++i) {
        const double time = scene.duration * (i + 0.5) / scene.images;
        if (radiance.empty() || !scene.motion.still())
            radiance = render(scene.world, scene.light, camera.device,
                              scene.motion.at(time) * camera.T_camera_lidar.inverse(), run);
        CameraImage image;
        image.label = camera.device.label;
        image.camera = camera.recorded_intrinsics();
        image.stamp = mrpt::Clock::fromDouble(begin + time);
        image.image =
            mrpt::img::CImage(expose(radiance, camera.device, seed + static_cast<std::uint64_t>(i)),
                              mrpt::img::SHALLOW_COPY);
        images.push_back(std::move(image));
        run.check_cancelled();
    }
    return images;
}

std::size_t chosen_of(const std::vector<CameraImage>& images, const std::string& choice) {
    if (choice == "last") return images.size() - 1;
    if (choice == "first") return 0;
    std::size_t best = 0;
    double best_sharpness = 0.0;
    for (std::size_t i = 0; i < images.size(); ++i) {
        const double sharp = sharpness(images[i].image.asCvMat<cv::Mat>(mrpt::img::SHALLOW_COPY));
        if (i == 0 || sharp > best_sharpness) {
            best = i;
            best_sharpness = sharp;
        }
    }
    return best;
}

/// The raw pixels of a board's corners; empty where one of them is not in the image.
std::vector<Eigen::Vector2d> pixels_of(const std::vector<Eigen::Vector3d>& corners,
                                       const SceneCamera& camera) {
    const mrpt::img::TCamera& intrinsics = camera.device.intrinsics;
    const CameraModel model(intrinsics);
    std::vector<Eigen::Vector2d> pixels;
    for (const Eigen::Vector3d& corner : corners) {
        const auto pixel = model.project(camera.T_camera_lidar * corner);
        if (!pixel || pixel->minCoeff() < 0.0 || pixel->x() > intrinsics.ncols - 1.0 ||
            pixel->y() > intrinsics.nrows - 1.0)
            return {};
        pixels.push_back(*pixel);
    }
    return pixels;
}

Truth truth_of(const Scene& scene, const Rig& rig, const std::vector<LidarMessage>& messages) {
    Truth truth;
    if (!rig.cameras.empty()) truth.T_camera_lidar = rig.cameras.front().T_camera_lidar;
    for (const simulation::SceneBoard& board : scene.boards) {
        Truth::Board known;
        known.target = board.target.name;
        known.T_lidar_board = board.T_world_board;  // the LiDAR's frame at time 0 is the world's
        for (const Eigen::Vector2d& p : board.target.corners())
            known.corners_lidar.push_back(board.T_world_board * Eigen::Vector3d(p.x(), p.y(), 0.0));
        if (!rig.cameras.empty())
            known.corners_image = pixels_of(known.corners_lidar, rig.cameras.front());
        truth.boards.push_back(std::move(known));
    }
    for (const LidarMessage& message : messages)
        truth.labels.insert(truth.labels.end(), message.label.begin(), message.label.end());
    return truth;
}

}  // namespace

SimulatedPackets simulate_packets(const Scene& scene, const Rig& rig, std::size_t number,
                                  const std::string& image_choice, Run& run) {
    const std::uint64_t lidar_seed = run.rng()();
    SimulatedPackets packets;
    packets.stamp = scene_begin(scene, number);
    const auto messages = simulation::simulate_lidar(scene.world, rig.lidar, scene.motion,
                                                     scene.duration, lidar_seed, run);
    packets.cloud = cloud_of(messages, rig.lidar_label, packets.stamp);
    packets.truth = truth_of(scene, rig, messages);
    for (const SceneCamera& camera : rig.cameras) {
        auto images = images_of(camera, scene, packets.stamp, run.rng()(), run);
        if (images.empty()) continue;
        const std::size_t chosen = chosen_of(images, image_choice);
        packets.images.cameras.push_back(std::move(images[chosen]));
        images.erase(images.begin() + static_cast<std::ptrdiff_t>(chosen));
        for (CameraImage& image : images) packets.images.others.push_back(std::move(image));
    }
    // As source.rawlog orders them.
    std::stable_sort(packets.images.cameras.begin(), packets.images.cameras.end(),
                     [](const CameraImage& a, const CameraImage& b) { return a.label < b.label; });
    std::stable_sort(packets.images.others.begin(), packets.images.others.end(),
                     [](const CameraImage& a, const CameraImage& b) { return a.stamp < b.stamp; });
    return packets;
}

}  // namespace petal
