// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "petal/calibration/angles.hpp"
#include "simulation/scene/object_keys.hpp"
#include "simulation/scene/placement.hpp"
#include "simulation/scene/scene_object.hpp"
#include "simulation/scene/solids.hpp"

namespace petal::simulation {
namespace {

double heading(const JsonValue& node) {
    const auto yaw = node.find("yaw_deg");
    return yaw ? yaw->number(-180.0, 180.0, "deg") / kDegrees : 0.0;
}

/// A frame inside another: moved, upright.
Eigen::Isometry3d moved(const Eigen::Isometry3d& frame, double x, double y, double z) {
    Eigen::Isometry3d result = frame;
    result.translate(Eigen::Vector3d(x, y, z));
    return result;
}

/// A panel on a face that looks back along the frame's x axis: `y`, `z` of its middle.
void add_plate(const SolidBuilder& builder, const Eigen::Isometry3d& frame,
               const Eigen::Vector3d& middle, double width, double height,
               const SharedTexture& texture) {
    Eigen::Isometry3d T_world_plate = frame;
    T_world_plate.translate(middle);
    T_world_plate.rotate(looking_ahead());
    T_world_plate.translate(Eigen::Vector3d(-0.5 * width, -0.5 * height, 0.0));
    builder.panel(T_world_plate, width, height, texture);
}

SharedTexture paint(const Eigen::Vector3f& colour, float reflectivity) {
    return std::make_shared<PlainTexture>(Look{colour, reflectivity});
}

}  // namespace

/// A small car, seen from behind: its frame has x ahead in the direction that it drives, and its
/// origin under the middle of its rear.
SceneObject read_car(const JsonValue& node) {
    node.only({"kind", "place", "yaw_deg", "colour", "bar", "bar_height"});
    const Eigen::Vector2d place = read_place(node);
    const double yaw = heading(node);
    const auto colour = node.find("colour");
    const SharedTexture body =
        paint(colour ? read_colour(*colour) : Eigen::Vector3f(0.75F, 0.75F, 0.72F), 0.35F);
    const double bar = read_length(node, "bar", 0.0, 0.0, 5.0);
    const double bar_height = read_length(node, "bar_height", 1.4, 0.3, 3.0);
    return [=](World& world, const Surroundings& around) {
        const SolidBuilder builder(world, Kind::foreground);
        const Eigen::Isometry3d rear = upright({place.x(), place.y(), around.floor}, yaw);
        const SharedTexture glass = material("glass"), rubber = material("rubber");
        builder.box(moved(rear, 1.5, 0.0, 0.25), {3.0, 1.5, 0.65}, body);   // lower body
        builder.box(moved(rear, 1.35, 0.0, 0.9), {2.2, 1.36, 0.62}, body);  // cabin
        builder.box(moved(rear, 1.5, 0.0, 0.14), {3.04, 1.52, 0.2}, rubber);
        // Window, number plate, lamps: each a little before the face that it is on.
        add_plate(builder, rear, {0.24, 0.0, 1.22}, 1.2, 0.46, glass);
        add_plate(builder, rear, {-0.01, 0.0, 0.68}, 0.44, 0.14, paint({0.15F, 0.5F, 0.3F}, 0.8F));
        for (const double side : {-1.0, 1.0}) {
            add_plate(builder, rear, {-0.01, side * 0.62, 0.76}, 0.22, 0.16,
                      paint({0.4F, 0.01F, 0.01F}, 0.6F));
            for (const double axle : {0.5, 2.5})  // wheels
                builder.bar(rear * Eigen::Vector3d(axle, side * 0.62, 0.29),
                            rear * Eigen::Vector3d(axle, side * 0.78, 0.29), 0.29, rubber);
        }
        if (bar > 0.0) {
            const double behind = -0.02;  // boards hang before it
            builder.bar(rear * Eigen::Vector3d(behind, -0.5 * bar, bar_height),
                        rear * Eigen::Vector3d(behind, 0.5 * bar, bar_height), 0.012,
                        material("steel"));
            for (const double side : {-0.3, 0.3})
                builder.bar(rear * Eigen::Vector3d(behind, side, bar_height),
                            rear * Eigen::Vector3d(0.25, side, bar_height), 0.012,
                            material("steel"));
        }
    };
}

/// A trunk, and a crown of leaves that are drawn with the scene: most light goes past most of them.
SceneObject read_tree(const JsonValue& node) {
    node.only({"kind", "place", "height", "crown", "leaves", "label"});
    const Eigen::Vector2d place = read_place(node);
    const double height = read_length(node, "height", 6.0, 0.5, 50.0);
    const double crown = read_length(node, "crown", 1.6, 0.1, 20.0);
    const auto leaves = node.find("leaves");
    const int count = leaves ? leaves->integer(1, 5000) : 250;
    const Kind kind = read_label(node, Kind::background);
    if (2.0 * crown >= height) node.fail("has a crown (a radius) that does not fit its height");
    return [=](World& world, const Surroundings& around) {
        const SolidBuilder builder(world, kind);
        const Eigen::Vector3d foot(place.x(), place.y(), around.floor);
        const Eigen::Vector3d middle = foot + Eigen::Vector3d(0.0, 0.0, height - crown);
        builder.bar(foot, middle, 0.03 + 0.015 * height, material("bark"));
        for (int leaf = 0; leaf < count; ++leaf) {
            Eigen::Isometry3d frame = Eigen::Isometry3d::Identity();
            frame.translate(middle + draw_in_ball(around.engine, crown));
            const Eigen::Vector3d axis = draw_in_ball(around.engine, 1.0);
            frame.rotate(Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), axis));
            // A twig's worth of leaves.
            const double size = crown * uniform(around.engine, 0.15, 0.35);
            builder.panel(frame, size, size, material("leaves"));
        }
    };
}

/// A block with one texture all around, a plinth, and a roof that overhangs.
SceneObject read_building(const JsonValue& node) {
    node.only({"kind", "place", "yaw_deg", "width", "depth", "height", "texture"});
    const Eigen::Vector2d place = read_place(node);
    const double yaw = heading(node);
    const double width = read_length(node, "width", 40.0, 1.0),
                 height = read_length(node, "height", 13.0, 1.0);
    const double depth = read_length(node, "depth", 12.0, 1.0);
    const SharedTexture texture = read_texture(node, "texture", "brick_windows");
    return [=](World& world, const Surroundings& around) {
        const SolidBuilder builder(world, Kind::background);
        const Eigen::Isometry3d front = upright({place.x(), place.y(), around.floor}, yaw);
        builder.box(moved(front, 0.5 * depth, 0.0, 0.0), {depth, width, height}, texture);
        builder.box(moved(front, 0.5 * depth, 0.0, 0.0), {depth + 0.3, width + 0.3, 0.8},
                    material("concrete"));
        builder.box(moved(front, 0.5 * depth, 0.0, height), {depth + 1.0, width + 1.0, 0.5},
                    material("brick"));
    };
}

}  // namespace petal::simulation
