// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "sources/detail/scene_builder.hpp"

#include <algorithm>
#include <opencv2/core.hpp>

#include "petal/error.hpp"
#include "petal/rawlog/lidar_points.hpp"
#include "petal/rawlog/sensor_label.hpp"
#include "sources/detail/sharpness.hpp"

namespace petal {

bool SensorChoice::takes_camera(const std::string& label) const {
    return cameras.empty() || label_fits_any(cameras, label);
}

void SensorList::add(const mrpt::obs::CObservation& observation) {
    classes_[observation.sensorLabel].insert(observation.GetRuntimeClass()->className);
    if (is_lidar(observation)) lidars_.insert(observation.sensorLabel);
    if (dynamic_cast<const mrpt::obs::CObservationImage*>(&observation) != nullptr)
        cameras_.insert(observation.sensorLabel);
}

std::string SensorList::text() const {
    std::string text;
    for (const auto& [label, classes] : classes_)
        for (const std::string& name : classes)
            text += (text.empty() ? "'" : ", '") + label + "' (" + name + ")";
    return text.empty() ? "none" : text;
}

void SceneBuilder::add(const mrpt::obs::CObservation::Ptr& observation,
                       const std::function<void(mrpt::obs::CObservation&)>& load) {
    const std::string& label = observation->sensorLabel;
    if (is_lidar(*observation)) {
        if (!choice_.lidar.empty() && !label_fits(choice_.lidar, label)) return;
        if (parts_ > 0 && label != cloud_.sensor_label) return;  // the caller tells of both
        load(*observation);
        add_points(*observation);
    } else if (auto* image = dynamic_cast<mrpt::obs::CObservationImage*>(observation.get())) {
        if (!choice_.takes_camera(label)) return;
        load(*observation);
        add_image(*image);
    }
}

void SceneBuilder::note_stamp(mrpt::Clock::time_point stamp) {
    if (stamp_ == 0.0 && stamp != mrpt::Clock::time_point{}) stamp_ = mrpt::Clock::toDouble(stamp);
}

void SceneBuilder::add_points(mrpt::obs::CObservation& observation) {
    mrpt::poses::CPose3D pose;
    observation.getSensorPose(pose);
    if (parts_ == 0) {
        cloud_.sensor_label = observation.sensorLabel;
        cloud_.sensor_pose = pose;
    } else if (pose != cloud_.sensor_pose && remarks_.empty()) {
        remarks_.push_back("the sensor pose of '" + observation.sensorLabel +
                           "' changes within the scene; the first is recorded, none is applied");
    }
    cloud_.parts.push_back({points_->size(), observation.timestamp});
    ++parts_;
    append_lidar_points(observation, *points_);
    note_stamp(observation.timestamp);
}

void SceneBuilder::add_image(mrpt::obs::CObservationImage& observation) {
    const std::string& label = observation.sensorLabel;
    const cv::Mat pixels = observation.image.isEmpty()
                               ? cv::Mat()
                               : observation.image.asCvMat<cv::Mat>(mrpt::img::SHALLOW_COPY);
    if (pixels.empty()) throw Error("an image of camera '" + label + "' is empty");
    if (pixels.depth() != CV_8U || (pixels.channels() != 1 && pixels.channels() != 3))
        throw Error("the images of camera '" + label + "' have " +
                    std::to_string(pixels.channels()) + " channels of " +
                    std::to_string(8 * pixels.elemSize1()) +
                    " bit; 1 or 3 channels of 8 bit are expected");
    mrpt::img::TCamera camera = observation.cameraParams;
    const auto width = static_cast<std::uint32_t>(pixels.cols);
    const auto height = static_cast<std::uint32_t>(pixels.rows);
    // A camera that was never calibrated: its size means nothing, and a detector that needs K says
    // so.
    const bool calibrated = camera.fx() > 0.0 || camera.fy() > 0.0;
    if (calibrated && (camera.ncols != width || camera.nrows != height))
        throw Error("an image of camera '" + label + "' measures " + std::to_string(width) + " x " +
                    std::to_string(height) + " px, but its intrinsics are for " +
                    std::to_string(camera.ncols) + " x " + std::to_string(camera.nrows) +
                    " px; put the intrinsics of this size into the rawlog");
    camera.ncols = width;
    camera.nrows = height;
    note_stamp(observation.timestamp);

    const double sharp = choice_.image == "sharpest" ? sharpness(pixels) : 0.0;
    const auto [at, is_new] = cameras_.try_emplace(label);
    Candidate& best = at->second;
    ++best.seen;
    const bool better = is_new || choice_.image == "last" ||
                        (choice_.image == "sharpest" && sharp > best.sharpness);
    if (!better) return;
    if (is_new && !calibrated) remarks_.push_back("camera '" + label + "' has no intrinsics");
    best.sharpness = sharp;
    best.image.label = label;
    best.image.image = observation.image;
    best.image.camera = camera;
    best.image.stamp = observation.timestamp;
    observation.getSensorPose(best.image.sensor_pose);
}

Cloud SceneBuilder::take_cloud() {
    if (parts_ == 0) cloud_.sensor_label = Cloud().sensor_label;
    cloud_.points = std::move(points_);
    return std::move(cloud_);
}

Images SceneBuilder::take_images() {
    Images images;
    for (auto& [label, candidate] : cameras_) images.cameras.push_back(std::move(candidate.image));
    return images;
}

}  // namespace petal
