// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "petal/calibration/angles.hpp"
#include "petal/calibration/target.hpp"
#include "simulation/scene/board_solid.hpp"
#include "simulation/scene/object_keys.hpp"
#include "simulation/scene/placement.hpp"
#include "simulation/scene/scene_object.hpp"
#include "simulation/scene/solids.hpp"

namespace petal::simulation {
namespace {

double read_yaw(const JsonValue& node) {
    const auto yaw = node.find("yaw_deg");
    return yaw ? yaw->number(-180.0, 180.0, "deg") / kDegrees : 0.0;
}

/// [from, to] of a coordinate, m.
Interval read_extent(const JsonValue& node, const std::string& key, const Interval& otherwise) {
    const auto value = node.find(key);
    if (!value) return otherwise;
    const Interval extent = read_interval(*value, -kFarthest, kFarthest, "m");
    if (!(extent.low < extent.high)) value->fail("must be [from, to] with from below to");
    return extent;
}

}  // namespace

SceneObject read_ground(const JsonValue& node) {
    node.only({"kind", "x", "y", "raise", "texture", "label"});
    const Interval x = read_extent(node, "x", {-100.0, 200.0});
    const Interval y = read_extent(node, "y", {-150.0, 150.0});
    const double raise = read_length(node, "raise", 0.0, -10.0, 10.0);
    const SharedTexture texture = read_texture(node, "texture", "concrete");
    const Kind kind = read_label(node, Kind::background);
    return [=](World& world, const Surroundings& around) {
        const Eigen::Isometry3d frame = upright({x.low, y.low, around.floor + raise}, 0.0);
        SolidBuilder(world, kind).panel(frame, x.high - x.low, y.high - y.low, texture);
    };
}

SceneObject read_box(const JsonValue& node) {
    node.only({"kind", "place", "raise", "yaw_deg", "size", "texture", "label"});
    const Eigen::Vector2d place = read_place(node);
    const double raise = read_length(node, "raise", 0.0, -10.0, 100.0);
    const double yaw = read_yaw(node);
    const Eigen::Vector3d size = node.at("size").vector3();
    if (!(size.minCoeff() > 0.0 && size.maxCoeff() <= kFarthest))
        node.at("size").fail("must be [depth, width, height] in m, each above 0 and at most 500");
    const SharedTexture texture = read_texture(node, "texture", "wood");
    const Kind kind = read_label(node, Kind::foreground);
    return [=](World& world, const Surroundings& around) {
        SolidBuilder(world, kind)
            .box(upright({place.x(), place.y(), around.floor + raise}, yaw), size, texture);
    };
}

SceneObject read_panel(const JsonValue& node) {
    node.only({"kind", "centre", "yaw_deg", "pitch_deg", "roll_deg", "width", "height", "texture",
               "look_alike", "label"});
    const Eigen::Vector3d centre = node.at("centre").vector3();
    const Eigen::Matrix3d turned = turned_deg(read_angles_deg(node)) * looking_ahead();
    double width = 0.0, height = 0.0;
    SharedTexture texture;
    if (const auto name = node.find("look_alike")) {
        for (const char* key : {"width", "height", "texture"})
            if (node.has(key))
                node.fail(std::string("has both look_alike and ") + key +
                          "; a look-alike is as large as its target and looks like it");
        const Target target = load_target(name->text());
        width = target.width();
        height = target.height();
        texture = look_alike_texture(target);
    } else {
        width = node.at("width").number(0.001, kFarthest, "m");
        height = node.at("height").number(0.001, kFarthest, "m");
        texture = read_texture(node, "texture", "white");
    }
    const Kind kind = read_label(node, Kind::foreground);
    return [=](World& world, const Surroundings&) {
        Eigen::Isometry3d frame = Eigen::Isometry3d::Identity();
        frame.translate(centre);
        frame.rotate(turned);
        frame.translate(Eigen::Vector3d(-0.5 * width, -0.5 * height, 0.0));
        SolidBuilder(world, kind).panel(frame, width, height, texture);
    };
}

SceneObject read_pole(const JsonValue& node) {
    node.only({"kind", "place", "height", "radius", "texture", "label"});
    const Eigen::Vector2d place = read_place(node);
    const double height = read_length(node, "height", 4.0);
    const double radius = read_length(node, "radius", 0.05, 0.001, 5.0);
    const SharedTexture texture = read_texture(node, "texture", "dark_steel");
    const Kind kind = read_label(node, Kind::foreground);
    return [=](World& world, const Surroundings& around) {
        const Eigen::Vector3d foot(place.x(), place.y(), around.floor);
        SolidBuilder(world, kind)
            .bar(foot, foot + Eigen::Vector3d(0.0, 0.0, height), radius, texture);
    };
}

SceneObject read_person(const JsonValue& node) {
    node.only({"kind", "place", "height", "yaw_deg", "texture"});
    const Eigen::Vector2d place = read_place(node);
    const double height = read_length(node, "height", 1.75, 0.5, 2.5);
    const double yaw = read_yaw(node);
    const SharedTexture cloth = read_texture(node, "texture", "cloth");
    return [=](World& world, const Surroundings& around) {
        const SolidBuilder builder(world, Kind::foreground);
        const Eigen::Isometry3d frame = upright({place.x(), place.y(), around.floor}, yaw);
        // Shares of the height: legs to 0.48, trunk and arms to 0.82, head to the top.
        const auto limb = [&](double left, double from, double to, double radius,
                              const SharedTexture& texture) {
            builder.bar(frame * Eigen::Vector3d(0.0, left * height, from * height),
                        frame * Eigen::Vector3d(0.0, left * height, to * height), radius * height,
                        texture);
        };
        for (const double side : {-1.0, 1.0}) {
            limb(side * 0.05, 0.0, 0.48, 0.045, material("dark_steel"));
            limb(side * 0.135, 0.42, 0.81, 0.028, cloth);
        }
        const Eigen::Vector3d trunk(0.11 * height, 0.2 * height, 0.35 * height);
        Eigen::Isometry3d waist = frame;
        waist.translate(Eigen::Vector3d(0.0, 0.0, 0.47 * height));
        builder.box(waist, trunk, cloth);
        limb(0.0, 0.82, 0.87, 0.03, material("skin"));
        Eigen::Isometry3d neck = frame;
        neck.translate(Eigen::Vector3d(0.0, 0.0, 0.87 * height));
        builder.box(neck, {0.11 * height, 0.09 * height, 0.13 * height}, material("skin"));
    };
}

SceneObject read_object(const JsonValue& node, std::size_t boards) {
    const std::string kind = node.at("kind").choice(
        {"ground", "wall", "room", "box", "panel", "pole", "person", "car", "tree", "building"});
    if (kind == "ground") return read_ground(node);
    if (kind == "wall") return read_wall(node, boards);
    if (kind == "room") return read_room(node, boards);
    if (kind == "box") return read_box(node);
    if (kind == "panel") return read_panel(node);
    if (kind == "pole") return read_pole(node);
    if (kind == "person") return read_person(node);
    if (kind == "car") return read_car(node);
    if (kind == "tree") return read_tree(node);
    return read_building(node);
}

}  // namespace petal::simulation
