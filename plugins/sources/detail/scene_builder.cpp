// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "sources/detail/scene_builder.hpp"

#include <algorithm>
#include <cstdlib>
#include <opencv2/core.hpp>
#include <utility>

#include "petal/error.hpp"
#include "petal/rawlog/lidar_points.hpp"
#include "petal/rawlog/sensor_label.hpp"
#include "sources/detail/sharpness.hpp"

namespace petal {
namespace {

constexpr std::size_t kMostSpread = 8;  // images of a camera that are held while a scene is read

}  // namespace

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
    Candidate& candidate = at->second;
    Numbered taken;
    taken.number = candidate.seen++;
    taken.image.label = label;
    taken.image.image = observation.image;
    taken.image.camera = camera;
    taken.image.stamp = observation.timestamp;
    observation.getSensorPose(taken.image.sensor_pose);
    if (is_new && !calibrated) remarks_.push_back("camera '" + label + "' has no intrinsics");
    const bool better = is_new || choice_.image == "last" ||
                        (choice_.image == "sharpest" && sharp > candidate.sharpness);
    if (better) {
        candidate.sharpness = sharp;
        candidate.best = taken;
    }
    spread_out(candidate, std::move(taken));
}

void SceneBuilder::spread_out(Candidate& candidate, Numbered image) {
    candidate.last = image;
    if (image.number % candidate.stride != 0) return;
    candidate.spread.push_back(std::move(image));
    if (candidate.spread.size() <= kMostSpread) return;
    // How many will come is not known: thinned by half whenever there are too many.
    candidate.stride *= 2;
    std::vector<Numbered> thinned;
    for (Numbered& one : candidate.spread)
        if (one.number % candidate.stride == 0) thinned.push_back(std::move(one));
    candidate.spread = std::move(thinned);
}

Cloud SceneBuilder::take_cloud() {
    if (parts_ == 0) cloud_.sensor_label = Cloud().sensor_label;
    cloud_.points = std::move(points_);
    return std::move(cloud_);
}

Images SceneBuilder::take_images() {
    Images images;
    for (auto& [label, candidate] : cameras_) {
        const Numbered* middle = &candidate.spread.front();
        for (const Numbered& one : candidate.spread)
            if (std::abs(2 * one.number - candidate.last.number) <
                std::abs(2 * middle->number - candidate.last.number))
                middle = &one;
        std::set<int> kept = {candidate.best.number};
        for (const Numbered* one :
             {&std::as_const(candidate.spread.front()), middle, &std::as_const(candidate.last)})
            if (kept.insert(one->number).second) images.others.push_back(one->image);
        images.cameras.push_back(std::move(candidate.best.image));
    }
    std::stable_sort(images.others.begin(), images.others.end(),
                     [](const CameraImage& a, const CameraImage& b) { return a.stamp < b.stamp; });
    return images;
}

}  // namespace petal
