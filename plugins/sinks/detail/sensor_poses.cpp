// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "sinks/detail/sensor_poses.hpp"

#include <mrpt/obs/CObservationImage.h>

#include "petal/error.hpp"

namespace petal {

SensorPoses::SensorPoses(const std::vector<CameraExtrinsics>& cameras, const std::string& reference)
    : reference_(reference.empty() && !cameras.empty() ? cameras.front().lidar : reference) {
    std::map<std::string, Eigen::Isometry3d> known{{reference_, Eigen::Isometry3d::Identity()}};
    std::vector<const CameraExtrinsics*> waiting;
    std::string labels;
    for (const CameraExtrinsics& camera : cameras) {
        waiting.push_back(&camera);
        labels += (labels.empty() ? "'" : ", '") + camera.camera + "' and '" + camera.lidar + "'";
        if (camera.diagnosis && camera.diagnosis->focal && camera.diagnosis->focal->estimated)
            focal_[camera.camera] = camera.diagnosis->focal->scale;
    }
    for (bool found = true; found && !waiting.empty();) {
        found = false;
        for (auto at = waiting.begin(); at != waiting.end();) {
            const CameraExtrinsics& pair = **at;
            const auto camera = known.find(pair.camera);
            const auto lidar = known.find(pair.lidar);
            if (camera == known.end() && lidar == known.end()) {
                ++at;
                continue;
            }
            if (camera != known.end() && lidar != known.end())
                throw Error("camera '" + pair.camera + "' and LiDAR '" + pair.lidar +
                            "' hang together in two ways in this result; which is to be taken?");
            if (camera != known.end())
                known[pair.lidar] = camera->second * pair.T_camera_lidar;
            else
                known[pair.camera] = lidar->second * pair.T_camera_lidar.inverse();
            at = waiting.erase(at);
            found = true;
        }
    }
    if (!waiting.empty())
        throw Error("no pose leads from the reference '" + reference_ + "' to camera '" +
                    waiting.front()->camera + "' and LiDAR '" + waiting.front()->lidar +
                    "'; the result has " + labels);
    known.erase(reference_);
    others_ = std::move(known);
}

double SensorPoses::focal_scale(const std::string& camera) const {
    const auto found = focal_.find(camera);
    return found == focal_.end() ? 1.0 : found->second;
}

void SensorPoses::apply(mrpt::obs::CObservation& observation,
                        const mrpt::poses::CPose3D& vehicle) const {
    const auto pose = others_.find(observation.sensorLabel);
    if (pose != others_.end()) {
        const mrpt::math::CMatrixDouble44 matrix(pose->second.matrix());
        observation.setSensorPose(vehicle + mrpt::poses::CPose3D(matrix));
    }
    const double scale = focal_scale(observation.sensorLabel);
    auto* image = dynamic_cast<mrpt::obs::CObservationImage*>(&observation);
    if (image == nullptr || scale == 1.0) return;
    image->cameraParams.fx(scale * image->cameraParams.fx());
    image->cameraParams.fy(scale * image->cameraParams.fy());
}

}  // namespace petal
