// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include <nlohmann/json.hpp>

#include "inspect.hpp"

namespace petal::cli {

namespace {

using Json = nlohmann::ordered_json;

const char* layout_name(RawlogInventory::Layout layout) {
    switch (layout) {
        case RawlogInventory::Layout::empty:
            return "empty";
        case RawlogInventory::Layout::observations:
            return "observations";
        case RawlogInventory::Layout::sensory_frames:
            return "sensory_frames";
        case RawlogInventory::Layout::mixed:
            return "mixed";
    }
    return "";
}

Json to_json(const Extent& extent) {
    if (extent.count == 0) return nullptr;
    return {{"min", extent.min}, {"max", extent.max}};
}

Json to_json(const std::optional<mrpt::Clock::time_point>& stamp) {
    return stamp ? Json(iso_time(*stamp)) : Json(nullptr);
}

Json to_json(const PointsInventory& points) {
    Extent per_message;
    for (const double count : points.per_message) per_message.add(count);
    Json json;
    json["total"] = points.total;
    json["per_message"] = nullptr;
    if (per_message.count > 0)
        json["per_message"] = {{"min", static_cast<std::size_t>(per_message.min)},
                               {"median", static_cast<std::size_t>(median(points.per_message))},
                               {"max", static_cast<std::size_t>(per_message.max)}};
    json["has_intensity"] = points.has_intensity;
    json["intensity"] = points.has_intensity ? to_json(points.intensity) : Json(nullptr);
    json["range_m"] = to_json(points.range);
    json["not_finite"] = points.not_finite;
    json["at_origin"] = points.at_origin;
    json["no_cloud"] = points.no_cloud.empty() ? Json(nullptr) : Json(points.no_cloud);
    return json;
}

Json to_json(const mrpt::img::TCamera& camera) {
    if (!(camera.fx() > 0.0 || camera.fy() > 0.0)) return nullptr;
    return {{"width", camera.ncols},
            {"height", camera.nrows},
            {"fx", camera.fx()},
            {"fy", camera.fy()},
            {"cx", camera.cx()},
            {"cy", camera.cy()},
            {"model", distortion_name(camera)},
            {"coefficients", coefficients(camera)}};
}

Json to_json(const std::string& eye, const ImagesInventory& images) {
    Json json;
    json["eye"] = eye;
    json["count"] = images.count;
    json["width"] = images.width;
    json["height"] = images.height;
    json["channels"] = images.channels;
    json["camera"] = to_json(images.camera);
    json["empty"] = images.empty;
    json["other_sizes"] = images.other_sizes;
    json["other_cameras"] = images.other_cameras;
    json["size_mismatches"] = images.size_mismatches;
    return json;
}

Json to_json(const SensorInventory& sensor) {
    const StampInventory& stamps = sensor.stamps;
    const auto [gaps, longest] = stamps.gaps();
    Json json;
    json["label"] = sensor.label;
    json["class"] = sensor.class_name;
    json["messages"] = sensor.messages;
    json["first_stamp"] = to_json(stamps.first());
    json["last_stamp"] = to_json(stamps.last());
    json["rate_hz"] = stamps.rate() > 0.0 ? Json(stamps.rate()) : Json(nullptr);
    json["unsteady"] = stamps.unsteady();
    json["gaps"] = {{"count", gaps}, {"longest_s", longest}};
    json["backward_stamps"] = stamps.backward();
    json["unknown_stamps"] = stamps.unknown();
    json["pose"] = nullptr;
    if (sensor.pose) {
        const auto& p = *sensor.pose;
        json["pose"] = {{"x", p.x()},
                        {"y", p.y()},
                        {"z", p.z()},
                        {"yaw_deg", mrpt::RAD2DEG(p.yaw())},
                        {"pitch_deg", mrpt::RAD2DEG(p.pitch())},
                        {"roll_deg", mrpt::RAD2DEG(p.roll())}};
    }
    json["other_poses"] = sensor.other_poses;
    json["external"] = sensor.external;
    json["unloaded"] = sensor.unloaded;
    json["points"] = sensor.points ? to_json(*sensor.points) : Json(nullptr);
    json["images"] = Json::array();
    for (const auto& [eye, images] : sensor.images) json["images"].push_back(to_json(eye, images));
    return json;
}

Json to_json(const Inspection& found) {
    const RawlogInventory& inventory = found.inventory;
    Json json;
    json["file"] = found.file.string();
    json["whole"] = found.errors.empty();
    json["errors"] = found.errors;
    json["warnings"] = found.warnings;
    json["layout"] = layout_name(inventory.layout());
    json["compressed"] = found.compressed;
    json["file_bytes"] = found.file_bytes;
    json["uncompressed_bytes"] = found.bytes;
    json["objects"] = found.objects;
    json["observations"] = inventory.observations();
    json["sensory_frames"] = inventory.sensory_frames();
    json["actions"] = inventory.actions();
    const auto time = inventory.time();
    json["first_stamp"] = time ? Json(iso_time(time->first)) : Json(nullptr);
    json["last_stamp"] = time ? Json(iso_time(time->second)) : Json(nullptr);
    json["duration_s"] =
        time ? Json(std::chrono::duration<double>(time->second - time->first).count())
             : Json(nullptr);
    json["sensors"] = Json::array();
    for (const auto& [key, sensor] : inventory.sensors())
        json["sensors"].push_back(to_json(sensor));
    return json;
}

}  // namespace

std::string inspection_json(const std::vector<Inspection>& inspections) {
    Json json;
    json["petal_inspect"] = 1;
    json["rawlogs"] = Json::array();
    for (const Inspection& found : inspections) json["rawlogs"].push_back(to_json(found));
    // Labels come from the file: bytes that are no UTF-8 are replaced.
    return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace petal::cli
