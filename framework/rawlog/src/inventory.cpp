// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "petal/rawlog/inventory.hpp"

#include <mrpt/maps/CPointsMapXYZI.h>
#include <mrpt/obs/CAction.h>
#include <mrpt/obs/CActionCollection.h>
#include <mrpt/obs/CObservation3DRangeScan.h>
#include <mrpt/obs/CObservationComment.h>
#include <mrpt/obs/CObservationImage.h>
#include <mrpt/obs/CObservationPointCloud.h>
#include <mrpt/obs/CObservationRotatingScan.h>
#include <mrpt/obs/CObservationStereoImages.h>
#include <mrpt/obs/CSensoryFrame.h>

#include <algorithm>
#include <cmath>

#include "petal/error.hpp"
#include "petal/rawlog/lidar_points.hpp"

namespace petal {
namespace {

using namespace mrpt::obs;

bool keeps_data_outside(const CObservation& observation) {
    if (const auto* image = dynamic_cast<const CObservationImage*>(&observation))
        return image->image.isExternallyStored();
    if (const auto* cloud = dynamic_cast<const CObservationPointCloud*>(&observation))
        return cloud->isExternallyStored();
    if (const auto* stereo = dynamic_cast<const CObservationStereoImages*>(&observation))
        return stereo->imageLeft.isExternallyStored() || stereo->imageRight.isExternallyStored();
    if (const auto* range = dynamic_cast<const CObservation3DRangeScan*>(&observation))
        return range->points3D_isExternallyStored() || range->rangeImage_isExternallyStored() ||
               range->intensityImage.isExternallyStored() ||
               range->confidenceImage.isExternallyStored();
    return false;
}

/// The ranges of a rotating scan, whether or not their directions are known.
void add_ranges(const CObservationRotatingScan& scan, PointsInventory& points) {
    const auto rows = static_cast<std::size_t>(scan.rangeImage.rows());
    const auto columns = static_cast<std::size_t>(scan.rangeImage.cols());
    const bool lit = scan.intensityImage.rows() == scan.rangeImage.rows() &&
                     scan.intensityImage.cols() == scan.rangeImage.cols();
    std::size_t returns = 0;
    for (std::size_t row = 0; row < rows; ++row)
        for (std::size_t column = 0; column < columns; ++column) {
            const auto raw = scan.rangeImage(row, column);
            if (raw == 0) continue;
            ++returns;
            points.range.add(raw * scan.rangeResolution);
            if (lit) points.intensity.add(scan.intensityImage(row, column) / 255.0);
        }
    points.total += returns;
    points.per_message.push_back(static_cast<double>(returns));
}

void add_points(CObservation& observation, PointsInventory& points) {
    points.has_intensity = points.has_intensity || has_intensity(observation);
    mrpt::maps::CPointsMapXYZI cloud;
    try {
        append_lidar_points(observation, cloud);
    } catch (const Error& e) {
        if (points.no_cloud.empty()) points.no_cloud = e.what();
        if (const auto* scan = dynamic_cast<const CObservationRotatingScan*>(&observation))
            add_ranges(*scan, points);
        return;
    }
    const auto& xs = cloud.getPointsBufferRef_x();
    const auto& ys = cloud.getPointsBufferRef_y();
    const auto& zs = cloud.getPointsBufferRef_z();
    for (std::size_t i = 0; i < cloud.size(); ++i) {
        const double x = xs[i], y = ys[i], z = zs[i];
        const double range = std::sqrt(x * x + y * y + z * z);
        if (!std::isfinite(range)) {
            ++points.not_finite;
            continue;
        }
        if (range == 0.0)
            ++points.at_origin;
        else
            points.range.add(range);
        if (points.has_intensity) points.intensity.add(cloud.getPointIntensity(i));
    }
    points.total += cloud.size();
    points.per_message.push_back(static_cast<double>(cloud.size()));
}

void add_image(const mrpt::img::CImage& image, const mrpt::img::TCamera& camera,
               ImagesInventory& images) {
    if (image.isEmpty()) {
        ++images.empty;
    } else {
        const int width = static_cast<int>(image.getWidth());
        const int height = static_cast<int>(image.getHeight());
        const int channels = static_cast<int>(image.channelCount());
        const bool calibrated = camera.fx() > 0.0 || camera.fy() > 0.0;
        if (images.width == 0) {
            images.width = width;
            images.height = height;
            images.channels = channels;
        } else if (width != images.width || height != images.height ||
                   channels != images.channels) {
            ++images.other_sizes;
        }
        if (calibrated &&
            (static_cast<int>(camera.ncols) != width || static_cast<int>(camera.nrows) != height))
            ++images.size_mismatches;
    }
    if (images.count == 0)
        images.camera = camera;
    else if (camera != images.camera)
        ++images.other_cameras;
    ++images.count;
}

void add_contents(CObservation& observation, SensorInventory& sensor) {
    if (is_lidar(observation)) {
        if (!sensor.points) sensor.points.emplace();
        add_points(observation, *sensor.points);
    }
    if (const auto* image = dynamic_cast<const CObservationImage*>(&observation)) {
        add_image(image->image, image->cameraParams, sensor.images[""]);
    } else if (const auto* stereo = dynamic_cast<const CObservationStereoImages*>(&observation)) {
        add_image(stereo->imageLeft, stereo->leftCamera, sensor.images["left"]);
        if (stereo->hasImageRight)
            add_image(stereo->imageRight, stereo->rightCamera, sensor.images["right"]);
    } else if (const auto* range = dynamic_cast<const CObservation3DRangeScan*>(&observation)) {
        if (range->hasIntensityImage)
            add_image(range->intensityImage, range->cameraParamsIntensity,
                      sensor.images["intensity"]);
    }
}

}  // namespace

void Extent::add(double value) {
    if (!std::isfinite(value)) return;
    min = count == 0 ? value : std::min(min, value);
    max = count == 0 ? value : std::max(max, value);
    ++count;
}

double median(std::vector<double> values) {
    if (values.empty()) return 0.0;
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

void StampInventory::add(mrpt::Clock::time_point stamp) {
    if (stamp == mrpt::Clock::time_point{}) {
        ++unknown_;
        return;
    }
    first_ = first_ ? std::min(*first_, stamp) : stamp;
    last_ = last_ ? std::max(*last_, stamp) : stamp;
    if (latest_) {
        if (stamp < *latest_)
            ++backward_;
        else
            intervals_.push_back(std::chrono::duration<double>(stamp - *latest_).count());
    }
    latest_ = stamp;
}

double StampInventory::rate() const {
    const double typical = interval();
    return typical > 0.0 ? 1.0 / typical : 0.0;
}

bool StampInventory::unsteady() const {
    const double typical = interval();
    const auto off = std::count_if(intervals_.begin(), intervals_.end(), [&](double interval) {
        return std::abs(interval - typical) > 0.5 * typical;
    });
    return static_cast<double>(off) > 0.1 * static_cast<double>(intervals_.size());
}

std::pair<std::size_t, double> StampInventory::gaps() const {
    const double typical = interval();
    std::pair<std::size_t, double> found{0, 0.0};
    for (const double interval : intervals_) {
        if (typical <= 0.0 || interval <= 3.0 * typical) continue;
        ++found.first;
        found.second = std::max(found.second, interval);
    }
    return found;
}

void RawlogInventory::add(mrpt::serialization::CSerializable& object, const Load& load) {
    if (auto* observation = dynamic_cast<CObservation*>(&object)) {
        ++free_observations_;
        add_observation(*observation, load);
    } else if (auto* frame = dynamic_cast<CSensoryFrame*>(&object)) {
        ++frames_;
        for (const auto& each : *frame)
            if (each) add_observation(*each, load);
    } else if (auto* actions = dynamic_cast<CActionCollection*>(&object)) {
        ++action_objects_;
        for (std::size_t i = 0; i < actions->size(); ++i)
            ++actions_[actions->get(i)->GetRuntimeClass()->className];
    } else if (dynamic_cast<CAction*>(&object) != nullptr) {
        ++action_objects_;
        ++actions_[object.GetRuntimeClass()->className];
    }
}

void RawlogInventory::add_observation(CObservation& observation, const Load& load) {
    ++observations_;
    const std::string class_name = observation.GetRuntimeClass()->className;
    SensorInventory& sensor = sensors_[{observation.sensorLabel, class_name}];
    sensor.label = observation.sensorLabel;
    sensor.class_name = class_name;
    ++sensor.messages;
    sensor.stamps.add(observation.timestamp);
    mrpt::poses::CPose3D pose;
    observation.getSensorPose(pose);
    if (!sensor.pose)
        sensor.pose = pose;
    else if (pose != *sensor.pose)
        ++sensor.other_poses;
    if (keeps_data_outside(observation)) ++sensor.external;
    try {
        load(observation);
    } catch (const Error& e) {
        if (sensor.unloaded++ == 0) sensor.first_unloaded = e.what();
        return;
    }
    add_contents(observation, sensor);
}

RawlogInventory::Layout RawlogInventory::layout() const {
    const bool framed = frames_ + action_objects_ > 0;
    if (framed) return free_observations_ > 0 ? Layout::mixed : Layout::sensory_frames;
    return free_observations_ > 0 ? Layout::observations : Layout::empty;
}

std::optional<std::pair<mrpt::Clock::time_point, mrpt::Clock::time_point>> RawlogInventory::time()
    const {
    std::optional<std::pair<mrpt::Clock::time_point, mrpt::Clock::time_point>> whole;
    for (const auto& [key, sensor] : sensors_) {
        if (key.second == CObservationComment::GetRuntimeClassIdStatic().className) continue;
        if (!sensor.stamps.first()) continue;
        if (!whole) whole.emplace(*sensor.stamps.first(), *sensor.stamps.last());
        whole->first = std::min(whole->first, *sensor.stamps.first());
        whole->second = std::max(whole->second, *sensor.stamps.last());
    }
    return whole;
}

}  // namespace petal
