// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include <cmath>

#include "petal/calibration/angles.hpp"
#include "petal/calibration/target.hpp"
#include "simulation/scene/board_solid.hpp"
#include "simulation/scene/materials.hpp"
#include "simulation/world/marker_texture.hpp"
#include "simulation/world/noise_texture.hpp"
#include "simulation/world/stripe_texture.hpp"
#include "simulation/world/tile_texture.hpp"
#include "simulation/world/window_texture.hpp"

namespace petal::simulation {
namespace {

constexpr double kWidest = 100.0;  // m: of one element of a pattern

double length(const JsonValue& node, const char* key, double otherwise) {
    const auto value = node.find(key);
    return value ? value->number(0.0005, kWidest, "m") : otherwise;
}

std::uint64_t seed_of(const JsonValue& node) {
    const auto seed = node.find("seed");
    return seed ? static_cast<std::uint64_t>(seed->integer(0, 1000000)) : 0;
}

Look look_of(const JsonValue& node, const char* key, const Look& otherwise) {
    const auto value = node.find(key);
    return value ? read_look(*value) : otherwise;
}

Look even_look(double lightness) {
    return {Eigen::Vector3f::Constant(static_cast<float>(lightness)),
            static_cast<float>(lightness)};
}

SharedTexture read_plain(const JsonValue& node) {
    node.only({"kind", "colour", "reflectivity"});
    Look look;
    look.colour = read_colour(node.at("colour"));
    look.reflectivity = static_cast<float>(node.at("reflectivity").number(0.0, 1.0, "1"));
    return std::make_shared<PlainTexture>(look);
}

SharedTexture read_checker(const JsonValue& node) {
    node.only({"kind", "first", "second", "size"});
    return std::make_shared<CheckerTexture>(read_look(node.at("first")),
                                            read_look(node.at("second")),
                                            node.at("size").number(0.0005, kWidest, "m"));
}

SharedTexture read_stripes(const JsonValue& node) {
    node.only({"kind", "first", "second", "width", "angle_deg"});
    const auto angle = node.find("angle_deg");
    return std::make_shared<StripeTexture>(
        read_look(node.at("first")), read_look(node.at("second")),
        node.at("width").number(0.0005, kWidest, "m"),
        angle ? angle->number(-180.0, 180.0, "deg") / kDegrees : 0.0);
}

SharedTexture read_noise(const JsonValue& node) {
    node.only({"kind", "low", "high", "size", "octaves", "seed"});
    const auto octaves = node.find("octaves");
    return std::make_shared<NoiseTexture>(read_look(node.at("low")), read_look(node.at("high")),
                                          length(node, "size", 0.3),
                                          octaves ? octaves->integer(1, 8) : 4, seed_of(node));
}

SharedTexture read_tiles(const JsonValue& node) {
    node.only(
        {"kind", "tile", "joint", "width", "height", "joint_width", "shift", "variation", "seed"});
    TileTexture::Layout layout;
    layout.width = length(node, "width", layout.width);
    layout.height = length(node, "height", layout.height);
    layout.joint = length(node, "joint_width", layout.joint);
    if (layout.joint >= std::min(layout.width, layout.height))
        node.fail("has joints that leave no tile: joint_width must be below width and height");
    if (const auto shift = node.find("shift")) layout.shift = shift->number(-1.0, 1.0, "1");
    if (const auto variation = node.find("variation"))
        layout.variation = variation->number(0.0, 1.0, "1");
    return std::make_shared<TileTexture>(read_look(node.at("tile")), read_look(node.at("joint")),
                                         layout, seed_of(node));
}

Eigen::Vector2d size_of(const JsonValue& node, const char* key, const Eigen::Vector2d& otherwise) {
    const auto value = node.find(key);
    if (!value) return otherwise;
    Eigen::Vector2d size = value->vector2();
    if (!(size.minCoeff() > 0.0 && size.maxCoeff() <= kWidest))
        value->fail("must be [across, up and down] in m, above 0 and at most 100");
    return size;
}

SharedTexture read_windows(const JsonValue& node) {
    node.only({"kind", "wall", "frame", "glass", "pitch", "size", "frame_width", "panes", "seed"});
    WindowTexture::Layout layout;
    layout.pitch = size_of(node, "pitch", layout.pitch);
    layout.size = size_of(node, "size", layout.size);
    layout.frame = length(node, "frame_width", layout.frame);
    if (const auto panes = node.find("panes")) layout.panes = panes->integer(1, 10);
    if ((layout.pitch - layout.size).minCoeff() < 0.0)
        node.fail("has windows that overlap: size must not be above pitch");
    if (layout.size.minCoeff() <= 2.0 * layout.frame)
        node.fail("has frames that leave no glass: frame_width must be below half of size");
    const Look glass = look_of(node, "glass", {{0.03F, 0.04F, 0.05F}, 0.03F});
    return std::make_shared<WindowTexture>(read_texture(node, "wall", "white_wall"),
                                           look_of(node, "frame", even_look(0.7)), glass, layout,
                                           seed_of(node));
}

SharedTexture read_marker(const JsonValue& node) {
    node.only({"kind", "dictionary", "id", "size", "dark", "light"});
    return std::make_shared<MarkerTexture>(
        node.at("dictionary").text(), node.at("id").integer(0, 999),
        node.at("size").number(0.005, kWidest, "m"), look_of(node, "dark", even_look(0.05)),
        look_of(node, "light", even_look(0.75)));
}

SharedTexture read_look_alike(const JsonValue& node) {
    node.only({"kind", "target"});
    return look_alike_texture(load_target(node.at("target").text()));
}

}  // namespace

Eigen::Vector3f read_colour(const JsonValue& node) {
    if (!node.is_list())
        return Eigen::Vector3f::Constant(static_cast<float>(node.number(0.0, 1.0, "1")));
    const Eigen::Vector3d colour = node.vector3();
    if (colour.minCoeff() < 0.0 || colour.maxCoeff() > 1.0)
        node.fail("must be red, green and blue from 0 to 1");
    return colour.cast<float>();
}

Look read_look(const JsonValue& node) {
    if (node.is_number()) return even_look(node.number(0.0, 1.0, "1"));
    node.only({"colour", "reflectivity"});
    return {read_colour(node.at("colour")),
            static_cast<float>(node.at("reflectivity").number(0.0, 1.0, "1"))};
}

SharedTexture read_texture(const JsonValue& node) {
    if (node.is_text()) return material(node.choice(material_names()));
    const std::string kind = node.at("kind").choice(
        {"plain", "checker", "stripes", "noise", "tiles", "windows", "marker", "look_alike"});
    if (kind == "plain") return read_plain(node);
    if (kind == "checker") return read_checker(node);
    if (kind == "stripes") return read_stripes(node);
    if (kind == "noise") return read_noise(node);
    if (kind == "tiles") return read_tiles(node);
    if (kind == "windows") return read_windows(node);
    if (kind == "marker") return read_marker(node);
    return read_look_alike(node);
}

SharedTexture read_texture(const JsonValue& node, const std::string& key,
                           const std::string& otherwise) {
    const auto value = node.find(key);
    return value ? read_texture(*value) : material(otherwise);
}

}  // namespace petal::simulation
