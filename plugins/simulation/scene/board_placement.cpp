// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulation/scene/board_placement.hpp"

#include <algorithm>
#include <limits>

#include "petal/calibration/angles.hpp"
#include "simulation/scene/board_cut.hpp"
#include "simulation/scene/object_keys.hpp"
#include "simulation/scene/placement.hpp"
#include "simulation/scene/solids.hpp"

namespace petal::simulation {
namespace {

constexpr double kNearestBoard = 0.2;    // m
constexpr double kFarthestBoard = 60.0;  // m

/// The middle of the outline's bounding box, on the front.
Eigen::Vector3d middle_of(const Target& target) {
    Eigen::AlignedBox2d box;
    for (const Eigen::Vector2d& p : target.outline) box.extend(p);
    return {box.center().x(), box.center().y(), 0.0};
}

double lowest_of(const Target& target, const Eigen::Isometry3d& T_world_board) {
    double lowest = std::numeric_limits<double>::infinity();
    for (const Eigen::Vector2d& p : target.outline)
        for (const double z : {0.0, target.thickness})
            lowest = std::min(lowest, (T_world_board * Eigen::Vector3d(p.x(), p.y(), z)).z());
    return lowest;
}

/// One number for all three, or a list of three; each from 0 to `most`.
Eigen::Vector3d read_spread(const JsonValue& node, double most, const char* unit) {
    if (!node.is_list()) return Eigen::Vector3d::Constant(node.number(0.0, most, unit));
    Eigen::Vector3d spread = node.vector3();
    if (spread.minCoeff() < 0.0 || spread.maxCoeff() > most)
        node.fail("must be from 0 to " + std::to_string(static_cast<int>(most)) + " " + unit);
    return spread;
}

}  // namespace

BoardPlacement::BoardPlacement(const JsonValue& node) : node_(node) {
    node.only({"target", "centre", "distance", "azimuth_deg", "elevation_deg", "yaw_deg",
               "pitch_deg", "roll_deg", "stands", "raise", "cord", "cut_sigma", "vary"});
    const auto name = node.find("target");
    const std::string target = name ? name->text() : "four_square_holes_500mm";
    try {
        target_file_ = find_target_file(target);
    } catch (const Error& error) {
        if (name) name->fail(error.what());
        throw;
    }
    target_ = load_target(target_file_);
    if (const auto stands = node.find("stands")) {
        const std::string choice = stands->choice({"none", "floor", "pole", "hung"});
        stands_ = choice == "floor"  ? Stands::floor
                  : choice == "pole" ? Stands::pole
                  : choice == "hung" ? Stands::hung
                                     : Stands::none;
    }
    angles_deg_ = read_angles_deg(node);
    read_place();
    read_variation();
    if (const auto sigma = node.find("cut_sigma")) cut_sigma_ = sigma->number(0.0, 0.005, "m");
    if (const auto raise = node.find("raise")) {
        if (stands_ != Stands::floor) raise->fail("goes with \"stands\": \"floor\" alone");
        raise_ = raise->number(0.0, 5.0, "m");
    }
    if (const auto cord = node.find("cord")) {
        if (stands_ != Stands::hung) cord->fail("goes with \"stands\": \"hung\" alone");
        cord_ = cord->number(0.01, 20.0, "m");
    }
}

void BoardPlacement::read_place() {
    const bool on_floor = stands_ == Stands::floor;
    if (node_.has("centre") == node_.has("distance"))
        node_.fail("needs either centre, or distance with azimuth_deg and elevation_deg");
    const auto angle = [this](const char* key) {
        const auto value = node_.find(key);
        return value ? value->number(-89.0, 89.0, "deg") / kDegrees : 0.0;
    };
    if (on_floor && node_.has("elevation_deg"))
        node_.at("elevation_deg").fail("is not needed: the board stands on the floor");
    if (const auto centre = node_.find("centre")) {
        for (const char* key : {"azimuth_deg", "elevation_deg"})
            if (node_.has(key)) node_.at(key).fail("goes with distance, not with centre");
        if (on_floor) {
            if (!centre->is_list() || centre->list().size() != 2)
                centre->fail("must be [x, y]: the board stands on the floor");
            centre_ << centre->vector2(), 0.0;
        } else {
            centre_ = centre->vector3();
        }
        if (!(centre_.norm() >= kNearestBoard && centre_.norm() <= kFarthestBoard))
            centre->fail("lies " + std::to_string(centre_.norm()) +
                         " m away; 0.2 to 60 m are expected");
        return;
    }
    const double distance = node_.at("distance").number(kNearestBoard, kFarthestBoard, "m");
    const double azimuth = angle("azimuth_deg"), elevation = angle("elevation_deg");
    centre_ =
        distance * Eigen::Vector3d(std::cos(azimuth) * std::cos(elevation),
                                   std::sin(azimuth) * std::cos(elevation), std::sin(elevation));
}

void BoardPlacement::read_variation() {
    const auto vary = node_.find("vary");
    if (!vary) return;
    vary->only({"position", "angle_deg"});
    if (const auto position = vary->find("position"))
        vary_position_ = read_spread(*position, 10.0, "m");
    if (const auto angle = vary->find("angle_deg"))
        vary_angles_deg_ = read_spread(*angle, 90.0, "deg");
}

SceneBoard BoardPlacement::draw(double floor, Engine& engine) const {
    Eigen::Vector3d centre = centre_, angles = angles_deg_;
    // Numbers are taken whether they vary or not: one more board that varies changes no other.
    for (int axis = 0; axis < 3; ++axis) {
        centre(axis) += vary_position_(axis) * uniform(engine, -1.0, 1.0);
        angles(axis) += vary_angles_deg_(axis) * uniform(engine, -1.0, 1.0);
    }
    SceneBoard board{target_, Eigen::Isometry3d::Identity()};
    board.T_world_board.translate(centre);
    board.T_world_board.rotate(turned_deg(angles) * looking_ahead());
    board.T_world_board.translate(-middle_of(target_));
    if (stands_ == Stands::floor)
        board.T_world_board.pretranslate(
            Eigen::Vector3d(0.0, 0.0, floor + raise_ - lowest_of(target_, board.T_world_board)));
    // A hair for rounding: a board on the floor touches it.
    const double under = floor - 1e-9 - lowest_of(target_, board.T_world_board);
    if (under > 0.0)
        node_.fail("reaches " + std::to_string(under) + " m under the floor (z = " +
                   std::to_string(floor) + " m): raise it, or lower the key floor");
    return board;
}

Target BoardPlacement::cut(std::uint64_t seed) const {
    Engine engine(seed);
    return cut_board(target_, cut_sigma_, engine);
}

void BoardPlacement::add_stand(World& world, const SceneBoard& board, double floor) const {
    const SolidBuilder builder(world, Kind::foreground);
    const Target& target = board.target;
    const Eigen::Vector3d back =
        board.T_world_board * (middle_of(target) + Eigen::Vector3d(0.0, 0.0, target.thickness));
    Eigen::Vector3d away = board.T_world_board.linear().col(2);
    away.z() = 0.0;
    away.normalize();
    if (stands_ == Stands::floor) {
        // A prop: from the middle of the back to the floor a hand behind.
        const Eigen::Vector3d foot(back.x() + 0.08 * away.x(), back.y() + 0.08 * away.y(), floor);
        builder.bar(foot, back + 0.012 * away, 0.008, material("steel"));
    } else if (stands_ == Stands::pole) {
        // Far enough behind for the board to lean towards it.
        const double lean = std::abs(board.T_world_board.linear().col(1).dot(away));
        const Eigen::Vector3d top = back + (0.05 + 0.5 * target.height() * lean) * away;
        builder.bar({top.x(), top.y(), floor}, top, 0.02, material("dark_steel"));
        builder.bar(back + 0.015 * away, top, 0.012, material("dark_steel"));
    } else if (stands_ == Stands::hung) {
        for (const double share : {0.1, 0.9}) {
            const Eigen::Vector3d hook =
                board.T_world_board *
                (middle_of(target) + Eigen::Vector3d((share - 0.5) * target.width(),
                                                     0.01 - 0.5 * target.height(),
                                                     target.thickness + 0.004));
            builder.bar(hook, hook + Eigen::Vector3d(0.0, 0.0, cord_), 0.003, material("white"));
        }
    }
}

}  // namespace petal::simulation
