// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulation/lidar/lidar_profile.hpp"

#include <algorithm>
#include <cmath>

#include "petal/calibration/angles.hpp"
#include "petal/calibration/shipped_file.hpp"
#include "petal/json_value.hpp"

namespace petal::simulation {
namespace {

constexpr double kFastest = 1e5;  // Hz, of anything that moves

double angle(const JsonValue& value, double low_deg, double high_deg) {
    return value.number(low_deg, high_deg, "deg") / kDegrees;
}

std::vector<double> angles(const JsonValue& value, double low_deg, double high_deg) {
    std::vector<double> all;
    for (const JsonValue& one : value.list()) all.push_back(angle(one, low_deg, high_deg));
    if (all.empty()) value.fail("must be a list of at least one angle (deg)");
    return all;
}

ScanPatternProfile read_prisms(const JsonValue& json) {
    json.only({"kind", "deflections_deg", "rates_rpm", "elevations_deg"});
    ScanPatternProfile pattern;
    pattern.kind = ScanPatternProfile::Kind::prisms;
    pattern.deflections = angles(json.at("deflections_deg"), 0.0, 60.0);
    const JsonValue rates = json.at("rates_rpm");
    for (const JsonValue& rate : rates.list())
        pattern.rates.push_back(rate.number(-60.0 * kFastest, 60.0 * kFastest, "rpm") / 60.0);
    if (pattern.rates.size() != pattern.deflections.size())
        rates.fail("must have one rate for each of the " +
                   std::to_string(pattern.deflections.size()) + " deflections_deg");
    const auto elevations = json.find("elevations_deg");
    pattern.elevations = elevations ? angles(*elevations, -45.0, 45.0) : std::vector<double>{0.0};
    return pattern;
}

ScanPatternProfile read_nodding(const JsonValue& json) {
    json.only({"kind", "rotation_hz", "swing_hz", "elevation_low_deg", "elevation_high_deg"});
    ScanPatternProfile pattern;
    pattern.kind = ScanPatternProfile::Kind::nodding;
    pattern.rotation = json.at("rotation_hz").number(-kFastest, kFastest, "Hz");
    pattern.swing = json.at("swing_hz").number(0.0, kFastest, "Hz");
    pattern.elevation_low = angle(json.at("elevation_low_deg"), -90.0, 90.0);
    const JsonValue high = json.at("elevation_high_deg");
    pattern.elevation_high = angle(high, -90.0, 90.0);
    if (!(pattern.elevation_low < pattern.elevation_high))
        high.fail("must be above elevation_low_deg");
    return pattern;
}

ScanPatternProfile read_rings(const JsonValue& json) {
    json.only({"kind", "rotation_hz", "elevations_deg"});
    ScanPatternProfile pattern;
    pattern.kind = ScanPatternProfile::Kind::rings;
    pattern.rotation = json.at("rotation_hz").number(-kFastest, kFastest, "Hz");
    pattern.elevations = angles(json.at("elevations_deg"), -90.0, 90.0);
    return pattern;
}

ScanPatternProfile read_pattern(const JsonValue& json) {
    const std::string kind = json.at("kind").choice({"prisms", "nodding", "rings"});
    if (kind == "prisms") return read_prisms(json);
    return kind == "nodding" ? read_nodding(json) : read_rings(json);
}

void read_errors(const JsonValue& json, LidarProfile& profile) {
    const JsonValue noise = json.at("range_noise");
    noise.only({"near", "far", "range", "reflectivity"});
    profile.range_noise_near = noise.at("near").number(0.0, 1.0, "m");
    profile.range_noise_far = noise.at("far").number(0.0, 1.0, "m");
    if (profile.range_noise_far < profile.range_noise_near)
        noise.at("far").fail("must not be below 'near': weak echoes are the noisier ones");
    profile.noise_range = noise.at("range").number(0.1, 1000.0, "m");
    profile.noise_reflectivity = noise.at("reflectivity").number(0.001, 1.0, "1");
    profile.range_offset_sigma = json.at("range_offset_sigma").number(0.0, 1.0, "m");
    profile.angular_noise = angle(json.at("angular_noise_deg"), 0.0, 5.0);
    profile.intensity_noise = json.at("intensity_noise").number(0.0, 1.0, "1");

    const JsonValue quantisation = json.at("quantisation");
    quantisation.only({"of", "step"});
    profile.quantised = quantisation.at("of").choice({"coordinates", "range"}) == "range"
                            ? LidarProfile::Quantised::range
                            : LidarProfile::Quantised::coordinates;
    profile.quantisation = quantisation.at("step").number(0.0, 0.1, "m");
    profile.dropout = json.at("dropout").number(0.0, 1.0, "1");
}

void read_beam(const JsonValue& json, LidarProfile& profile) {
    profile.footprint_vertical = angle(json.at("footprint_vertical_deg"), 0.0, 5.0);
    profile.footprint_horizontal = angle(json.at("footprint_horizontal_deg"), 0.0, 5.0);
    profile.pulse_width = json.at("pulse_width").number(0.001, 10.0, "m");
    profile.late_error = json.at("late_error").number(0.0, 0.1, "m");
    profile.range_min = json.at("range_min").number(0.0, 100.0, "m");
    const JsonValue range_max = json.at("range_max");
    profile.range_max = range_max.number(0.1, 10000.0, "m");
    if (!(profile.range_min < profile.range_max)) range_max.fail("must be above range_min");
    const JsonValue detection = json.at("detection");
    detection.only({"range", "reflectivity"});
    profile.detection_range = detection.at("range").number(0.1, 10000.0, "m");
    profile.detection_reflectivity = detection.at("reflectivity").number(0.001, 1.0, "1");
    profile.returned = json.at("return").choice({"first", "strongest"}) == "first"
                           ? LidarProfile::Return::first
                           : LidarProfile::Return::strongest;
}

}  // namespace

double LidarProfile::range_noise(double energy) const {
    const double at_far = noise_reflectivity / (noise_range * noise_range);
    const double square = range_noise_near * range_noise_near;
    // The number of photons is proportional to the energy, and its noise to the root of it.
    return std::sqrt(square + (range_noise_far * range_noise_far - square) * at_far / energy);
}

double LidarProfile::rim() const {
    double highest = std::max(std::abs(pattern.elevation_low), std::abs(pattern.elevation_high));
    for (const double elevation : pattern.elevations)
        highest = std::max(highest, std::abs(elevation));
    for (const double deflection : pattern.deflections) highest += deflection;
    return highest;
}

std::filesystem::path find_lidar_profile(const std::filesystem::path& name_or_path) {
    return find_shipped_file("sensors", "LiDAR", name_or_path);
}

LidarProfile load_lidar_profile(const std::filesystem::path& name_or_path) {
    const JsonValue json = JsonValue::read(find_lidar_profile(name_or_path), "LiDAR");
    json.only({"petal_lidar", "name", "pattern", "points_per_second", "messages_per_second",
               "footprint_vertical_deg", "footprint_horizontal_deg", "pulse_width", "late_error",
               "range_noise", "range_offset_sigma", "angular_noise_deg", "intensity_noise",
               "quantisation", "range_min", "range_max", "detection", "return", "dropout"});
    const JsonValue version = json.at("petal_lidar");
    if (version.number() != 1.0) version.fail("is the version of the format and must be 1");
    LidarProfile profile;
    profile.name = json.at("name").text();
    profile.pattern = read_pattern(json.at("pattern"));
    profile.points_per_second = json.at("points_per_second").number(1.0, 1e8, "points/s");
    profile.messages_per_second = json.at("messages_per_second").number(0.01, 1000.0, "Hz");
    if (profile.points_per_second < profile.messages_per_second)
        json.at("messages_per_second").fail("must not be above points_per_second");
    read_beam(json, profile);
    read_errors(json, profile);
    return profile;
}

}  // namespace petal::simulation
