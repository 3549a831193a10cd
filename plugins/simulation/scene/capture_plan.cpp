// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulation/scene/capture_plan.hpp"

#include <limits>
#include <utility>

#include "petal/calibration/angles.hpp"
#include "petal/printed.hpp"
#include "simulation/scene/board_solid.hpp"
#include "simulation/scene/materials.hpp"

namespace petal::simulation {
namespace {

constexpr int kTries = 100;           // to place the boards so that every rig sees them
constexpr double kImageMargin = 5.0;  // px: a hole's rim needs some image around it

/// The capture's own value of a key, or the scene's.
std::optional<JsonValue> either(const JsonValue& scene, const std::optional<JsonValue>& capture,
                                const std::string& key) {
    if (capture)
        if (auto value = capture->find(key)) return value;
    return scene.find(key);
}

}  // namespace

CapturePlan::CapturePlan(const JsonValue& scene, const std::optional<JsonValue>& capture,
                         std::string name)
    : name_(std::move(name)) {
    if (capture)
        capture->only(
            {"name", "floor", "duration", "images", "light", "motion", "boards", "objects"});
    if (const auto floor = either(scene, capture, "floor"))
        floor_ = floor->number(-100.0, 10.0, "m");
    if (const auto duration = either(scene, capture, "duration"))
        duration_ = duration->number(0.1, 600.0, "s");
    if (const auto images = either(scene, capture, "images")) images_ = images->integer(1, 1000);
    if (const auto light = either(scene, capture, "light")) read_light(*light);
    if (const auto motion = either(scene, capture, "motion")) read_motion(*motion);
    const JsonValue boards = capture ? capture->at("boards") : scene.at("boards");
    for (const JsonValue& board : boards.list()) boards_.emplace_back(board);
    if (boards_.empty()) boards.fail("must list at least one board");
    if (const auto objects = either(scene, capture, "objects"))
        for (const std::string& key : objects->keys())
            objects_.push_back(read_object(objects->at(key), boards_.size()));
}

void CapturePlan::read_light(const JsonValue& light) {
    light.only({"azimuth_deg", "elevation_deg", "lamp", "ambient", "sky"});
    if (light.has("azimuth_deg") != light.has("elevation_deg"))
        light.fail("needs both azimuth_deg and elevation_deg of the lamp, or neither");
    if (light.has("azimuth_deg")) {
        const double azimuth = light.at("azimuth_deg").number(-360.0, 360.0, "deg") / kDegrees;
        const double elevation = light.at("elevation_deg").number(-90.0, 90.0, "deg") / kDegrees;
        light_.to_lamp = {std::cos(azimuth) * std::cos(elevation),
                          std::sin(azimuth) * std::cos(elevation), std::sin(elevation)};
    }
    if (const auto lamp = light.find("lamp"))
        light_.lamp = static_cast<float>(lamp->number(0.0, 100.0, "1"));
    if (const auto ambient = light.find("ambient"))
        light_.ambient = static_cast<float>(ambient->number(0.0, 100.0, "1"));
    if (const auto sky = light.find("sky")) light_.sky = read_colour(*sky);
}

void CapturePlan::read_motion(const JsonValue& motion) {
    motion.only({"velocity", "angular_velocity_deg", "begins"});
    if (const auto velocity = motion.find("velocity")) {
        motion_.velocity = velocity->vector3();
        if (motion_.velocity.norm() > 50.0) velocity->fail("must be at most 50 m/s");
    }
    if (const auto turning = motion.find("angular_velocity_deg")) {
        motion_.angular_velocity = turning->vector3() / kDegrees;
        if (motion_.angular_velocity.norm() * kDegrees > 720.0)
            turning->fail("must be at most 720 deg/s");
    }
    if (const auto begins = motion.find("begins")) motion_.begins = begins->number(0.0, 600.0, "s");
}

Scene CapturePlan::draw(const RigPlan& rig, Engine& engine, std::uint64_t boards_seed) const {
    Scene scene;
    scene.name = name_;
    scene.light = light_;
    scene.motion = motion_;
    scene.duration = duration_;
    scene.images = images_;

    double nearest_miss = -std::numeric_limits<double>::infinity();
    std::size_t missing = 0;
    for (int attempt = 0; attempt < kTries; ++attempt) {
        scene.boards.clear();
        for (const BoardPlacement& board : boards_)
            scene.boards.push_back(board.draw(floor_, engine));
        double worst = std::numeric_limits<double>::infinity();
        std::size_t worst_board = 0;
        for (std::size_t i = 0; i < scene.boards.size(); ++i) {
            const double margin = rig.image_margin(scene.boards[i]);
            if (margin >= worst) continue;
            worst = margin;
            worst_board = i;
        }
        if (worst > nearest_miss) {
            nearest_miss = worst;
            missing = worst_board;
        }
        if (worst >= kImageMargin) break;
    }
    if (nearest_miss < kImageMargin)
        boards_[missing].node().fail(
            "does not stay inside the image: of the rigs within " +
            printed("%g deg and %g m", rig.rotation_deg(), rig.translation()) +
            " of the mounting, some see a corner of it " +
            (nearest_miss < -1e6 ? "far outside"
                                 : printed("%.0f px", kImageMargin - nearest_miss) +
                                       " too near to the border, or beyond it,") +
            " in the best of " + std::to_string(kTries) +
            " placements; move it towards the middle or farther away, or let rig vary less");

    for (std::size_t i = 0; i < boards_.size(); ++i) {
        add_board(scene.world, boards_[i].cut(mix(boards_seed, i)), scene.boards[i].T_world_board);
        boards_[i].add_stand(scene.world, scene.boards[i], floor_);
    }
    const Surroundings around{floor_, scene.boards, engine};
    for (const SceneObject& object : objects_) object(scene.world, around);
    scene.world.build();
    return scene;
}

std::vector<std::filesystem::path> CapturePlan::target_files() const {
    std::vector<std::filesystem::path> files;
    for (const BoardPlacement& board : boards_) files.push_back(board.target_file());
    return files;
}

}  // namespace petal::simulation
