// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include <algorithm>
#include <limits>
#include <optional>
#include <string>

#include "petal/calibration/angles.hpp"
#include "simulation/scene/object_keys.hpp"
#include "simulation/scene/placement.hpp"
#include "simulation/scene/scene_object.hpp"
#include "simulation/scene/solids.hpp"

namespace petal::simulation {
namespace {

constexpr double kPaper = 0.002;  // m: a poster before its wall

struct Poster {
    double left, up;  ///< of its middle: from the wall's middle, from the floor
    double width, height;
    SharedTexture texture;
};

std::vector<Poster> read_posters(const JsonValue& node) {
    std::vector<Poster> posters;
    const auto list = node.find("posters");
    if (!list) return posters;
    for (const JsonValue& item : list->list()) {
        item.only({"at", "width", "height", "texture"});
        const Eigen::Vector2d at = item.at("at").vector2();
        posters.push_back({at.x(), at.y(), item.at("width").number(0.01, 50.0, "m"),
                           item.at("height").number(0.01, 50.0, "m"),
                           read_texture(item.at("texture"))});
    }
    return posters;
}

/// How far away an upright wall stands: a distance from the LiDAR, or a gap behind boards.
struct Standing {
    double yaw = 0.0;  ///< rad: 0 faces back along x
    std::optional<Interval> distance, gap;
    std::optional<std::size_t> behind;  ///< this board alone; else all

    Eigen::Vector3d ahead() const { return {std::cos(yaw), std::sin(yaw), 0.0}; }
    Eigen::Vector3d left() const { return {-std::sin(yaw), std::cos(yaw), 0.0}; }

    double place(const Surroundings& around) const {
        if (distance) return distance->draw(around.engine);
        double farthest = -std::numeric_limits<double>::infinity();
        for (std::size_t i = 0; i < around.boards.size(); ++i) {
            if (behind && *behind != i) continue;
            const SceneBoard& board = around.boards[i];
            for (const Eigen::Vector2d& p : board.target.outline)
                farthest = std::max(
                    farthest, ahead().dot(board.T_world_board *
                                          Eigen::Vector3d(p.x(), p.y(), board.target.thickness)));
        }
        return farthest + gap->draw(around.engine);
    }
};

Standing read_standing(const JsonValue& node, std::size_t boards) {
    Standing standing;
    if (const auto yaw = node.find("yaw_deg"))
        standing.yaw = yaw->number(-80.0, 80.0, "deg") / kDegrees;
    if (node.has("distance") == node.has("gap"))
        node.fail("needs either distance (m from the LiDAR) or gap (m behind the boards)");
    if (const auto distance = node.find("distance"))
        standing.distance = read_interval(*distance, 0.1, kFarthest, "m");
    if (const auto gap = node.find("gap")) standing.gap = read_interval(*gap, 0.0, kFarthest, "m");
    if (const auto behind = node.find("behind")) {
        if (!standing.gap) behind->fail("goes with gap, not with distance");
        if (behind->is_text())
            behind->choice({"boards"});
        else
            standing.behind =
                static_cast<std::size_t>(behind->integer(0, static_cast<int>(boards) - 1));
    }
    return standing;
}

/// An upright sheet whose middle stands `distance` ahead and `aside` to the left.
struct Sheet {
    double yaw, distance, aside, width, bottom, height;
    SharedTexture texture;
    std::vector<Poster> posters;

    void add_to(World& world, double floor) const {
        const SolidBuilder builder(world, Kind::background);
        const auto panel = [&](double left, double top, double nearer, double across, double down,
                               const SharedTexture& look) {
            Eigen::Isometry3d frame = upright({0.0, 0.0, 0.0}, yaw);
            frame.translate(Eigen::Vector3d(distance - nearer, aside + left, floor + top));
            frame.rotate(looking_ahead());
            builder.panel(frame, across, down, look);
        };
        panel(0.5 * width, bottom + height, 0.0, width, height, texture);
        for (std::size_t i = 0; i < posters.size(); ++i) {
            const Poster& poster = posters[i];
            // Later ones hang before earlier ones.
            panel(poster.left + 0.5 * poster.width, poster.up + 0.5 * poster.height,
                  kPaper * static_cast<double>(i + 1), poster.width, poster.height, poster.texture);
        }
    }
};

}  // namespace

SceneObject read_wall(const JsonValue& node, std::size_t boards) {
    node.only({"kind", "distance", "gap", "behind", "yaw_deg", "aside", "width", "height", "raise",
               "texture", "posters"});
    const Standing standing = read_standing(node, boards);
    Sheet sheet{standing.yaw,
                0.0,
                read_length(node, "aside", 0.0, -kFarthest, kFarthest),
                read_length(node, "width", 10.0),
                read_length(node, "raise", 0.0, -10.0, 100.0),
                read_length(node, "height", 4.0),
                read_texture(node, "texture", "white_wall"),
                read_posters(node)};
    return [standing, sheet](World& world, const Surroundings& around) {
        Sheet placed = sheet;
        placed.distance = standing.place(around);
        placed.add_to(world, around.floor);
    };
}

SceneObject read_room(const JsonValue& node, std::size_t boards) {
    node.only({"kind", "distance", "gap", "behind", "left", "right", "back", "height", "wall",
               "side_wall", "floor", "posters"});
    const Standing standing = read_standing(node, boards);
    const double left = read_length(node, "left", 4.0), right = read_length(node, "right", 4.0);
    const double back = read_length(node, "back", 3.0), height = read_length(node, "height", 4.0);
    const SharedTexture front = read_texture(node, "wall", "white_wall");
    const SharedTexture sides = read_texture(node, "side_wall", "white_wall");
    const SharedTexture floor = read_texture(node, "floor", "grey_floor");
    const std::vector<Poster> posters = read_posters(node);
    return [=](World& world, const Surroundings& around) {
        const double ahead = standing.place(around);
        Sheet{0.0, ahead, 0.5 * (left - right), left + right, 0.0, height, front, posters}.add_to(
            world, around.floor);
        const double depth = ahead + back, quarter = std::acos(0.0);
        // Turned left by a quarter, "aside" counts towards the back; turned right, towards the
        // front.
        const double middle = 0.5 * (ahead - back);
        Sheet{quarter, left, -middle, depth, 0.0, height, sides, {}}.add_to(world, around.floor);
        Sheet{-quarter, right, middle, depth, 0.0, height, sides, {}}.add_to(world, around.floor);
        SolidBuilder(world, Kind::background)
            .panel(upright({-back, -right, around.floor}, 0.0), depth, left + right, floor);
    };
}

}  // namespace petal::simulation
