// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include <array>
#include <cstdio>
#include <ctime>

#include "inspect.hpp"

namespace petal::cli {

namespace {

std::string of(std::size_t part, std::size_t whole, const std::string& what) {
    return (part == whole ? "all " + std::to_string(whole)
                          : std::to_string(part) + " of " + std::to_string(whole)) +
           " " + what;
}

void judge_stamps(const SensorInventory& sensor, const std::string& name, Inspection& found) {
    if (sensor.stamps.unknown() > 0)
        found.warnings.push_back(
            name + of(sensor.stamps.unknown(), sensor.messages, "messages have no stamp"));
    if (sensor.stamps.backward() > 0)
        found.warnings.push_back(name + of(sensor.stamps.backward(), sensor.messages,
                                           "stamps lie before the one before them"));
}

void judge_points(const PointsInventory& points, const std::string& name, Inspection& found) {
    if (!points.no_cloud.empty())
        found.warnings.push_back(name + "no cloud can be made of it: " + points.no_cloud);
    else if (points.total == 0)
        found.warnings.push_back(name + "not one point");
    if (points.not_finite > 0)
        found.warnings.push_back(name +
                                 of(points.not_finite, points.total, "points are not finite"));
    if (points.at_origin > 0)
        found.warnings.push_back(
            name + of(points.at_origin, points.total, "points are exactly (0, 0, 0): no returns?"));
}

void judge_images(const ImagesInventory& images, const std::string& name, Inspection& found) {
    if (images.empty > 0)
        found.warnings.push_back(name + of(images.empty, images.count, "images are empty"));
    if (images.other_sizes > 0)
        found.warnings.push_back(
            name + of(images.other_sizes, images.count, "images have another size than the first"));
    if (images.size_mismatches > 0)
        found.warnings.push_back(
            name + of(images.size_mismatches, images.count, "images have another size than their") +
            " intrinsics, which are for " + std::to_string(images.camera.ncols) + " x " +
            std::to_string(images.camera.nrows) + " px; no calibration runs with them");
    if (images.other_cameras > 0)
        found.warnings.push_back(name + of(images.other_cameras, images.count,
                                           "images have other intrinsics than the first"));
}

}  // namespace

void judge(Inspection& found) {
    if (found.opened && found.errors.empty() && found.objects == 0)
        found.errors.push_back(
            "rawlog " + found.file.string() +
            (found.file_bytes == 0 ? " is empty (0 bytes)" : " holds no object at all"));
    for (const auto& [key, sensor] : found.inventory.sensors()) {
        const std::string name = "'" + sensor.label + "': ";
        if (sensor.unloaded > 0)
            found.errors.push_back(sensor.first_unloaded +
                                   (sensor.unloaded > 1
                                        ? "; so for " + std::to_string(sensor.unloaded) +
                                              " messages of " + std::to_string(sensor.messages)
                                        : std::string()));
        judge_stamps(sensor, name, found);
        if (sensor.points && sensor.points->per_message.size() + sensor.unloaded > 0)
            judge_points(*sensor.points, name, found);
        for (const auto& [eye, images] : sensor.images)
            judge_images(images, eye.empty() ? name : name + eye + ": ", found);
        if (sensor.other_poses > 0)
            found.warnings.push_back(name + of(sensor.other_poses, sensor.messages,
                                               "messages have another pose than the first"));
    }
}

std::string distortion_name(const mrpt::img::TCamera& camera) {
    switch (camera.distortion) {
        case mrpt::img::DistortionModel::none:
            return "none";
        case mrpt::img::DistortionModel::plumb_bob:
            return "plumb_bob";
        case mrpt::img::DistortionModel::kannala_brandt:
            return "kannala_brandt";
    }
    return "unknown";
}

std::vector<double> coefficients(const mrpt::img::TCamera& camera) {
    if (camera.distortion == mrpt::img::DistortionModel::kannala_brandt)
        // MRPT keeps its k1..k4 apart, where plumb_bob has k1, k2, k3 and k4.
        return {camera.dist[0], camera.dist[1], camera.dist[4], camera.dist[5]};
    if (camera.distortion != mrpt::img::DistortionModel::plumb_bob) return {};
    std::vector<double> values(camera.dist.begin(), camera.dist.end());
    while (values.size() > 5 && values.back() == 0.0) values.pop_back();
    return values;
}

std::string iso_time(mrpt::Clock::time_point stamp) {
    // Ticks of 100 ns since 1601, of which 11644473600 s lie before 1970.
    const std::int64_t ticks = stamp.time_since_epoch().count() - 116444736000000000LL;
    std::int64_t seconds = ticks / 10000000;
    std::int64_t rest = ticks % 10000000;
    if (rest < 0) {
        rest += 10000000;
        --seconds;
    }
    const auto time = static_cast<std::time_t>(seconds);
    std::tm parts = {};
    if (gmtime_r(&time, &parts) == nullptr) return "unknown";
    std::array<char, 64> text = {};
    std::snprintf(text.data(), text.size(), "%04d-%02d-%02dT%02d:%02d:%02d.%06dZ",
                  parts.tm_year + 1900, parts.tm_mon + 1, parts.tm_mday, parts.tm_hour,
                  parts.tm_min, parts.tm_sec, static_cast<int>(rest / 10));
    return text.data();
}

}  // namespace petal::cli
