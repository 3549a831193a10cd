// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulation/scene/board_solid.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace petal::simulation {
namespace {

/// The board's frame is the world's: the front is z = 0, and one looks along +z.
World board_alone(const Target& target) {
    World world;
    add_board(world, target, Eigen::Isometry3d::Identity());
    world.build();
    return world;
}

/// From 1 m before the front, straight at a place of it.
Ray at_front(double x, double y) {
    return {Eigen::Vector3d(x, y, -1.0), Eigen::Vector3d::UnitZ()};
}

Hit first(const World& world, const Ray& ray) {
    return world.cast(ray, 100.0);
}

TEST(BoardSolid, SquareHolesAreOpenAndThePlateIsAsThickAsTold) {
    const Target target = load_target("four_square_holes_500mm");
    const World world = board_alone(target);
    for (const auto& hole : target.holes) {
        const Eigen::Vector2d middle = 0.5 * (hole[0] + hole[2]);
        EXPECT_EQ(first(world, at_front(middle.x(), middle.y())).surface, nullptr);
        for (const Eigen::Vector2d& corner : hole) {
            // A tenth of a millimetre either way of the corner, along the diagonal.
            const Eigen::Vector2d in = corner + 1e-4 * (middle - corner).normalized();
            const Eigen::Vector2d out = corner - 1e-4 * (middle - corner).normalized();
            EXPECT_EQ(first(world, at_front(in.x(), in.y())).surface, nullptr);
            const Hit hit = first(world, at_front(out.x(), out.y()));
            ASSERT_NE(hit.surface, nullptr);
            EXPECT_EQ(hit.surface->kind(), Kind::board);
            EXPECT_DOUBLE_EQ(hit.range, 1.0);
        }
    }
    const Hit back =
        first(world, {Eigen::Vector3d(0.25, 0.25, 1.0), Eigen::Vector3d(0.0, 0.0, -1.0)});
    ASSERT_NE(back.surface, nullptr);
    EXPECT_DOUBLE_EQ(back.range, 1.0 - target.thickness);
    EXPECT_EQ(first(world, at_front(0.25, 0.501)).surface, nullptr) << "beside the board";
}

TEST(BoardSolid, ObliqueRaysMeetTheWallsOfHolesAndTheOuterSides) {
    const World world = board_alone(load_target("four_square_holes_500mm"));
    // At 45 degrees into the first hole, 2 mm from its right side: met 2 mm behind the front.
    const Eigen::Vector3d direction = Eigen::Vector3d(1.0, 0.0, 1.0).normalized();
    const Hit wall = first(world, {Eigen::Vector3d(0.198 - 1.0, 0.15, -1.0), direction});
    ASSERT_NE(wall.surface, nullptr);
    EXPECT_EQ(wall.surface->kind(), Kind::board);
    EXPECT_NEAR(wall.range, 1.002 * std::sqrt(2.0), 1e-12);
    EXPECT_NEAR(wall.normal.x(), -1.0, 1e-12);
    // 6 mm from it the ray leaves through the back: the plate is 5 mm thick.
    EXPECT_EQ(first(world, {Eigen::Vector3d(0.194 - 1.0, 0.15, -1.0), direction}).surface, nullptr);
    const Hit side = first(world, {Eigen::Vector3d(0.25, 2.0, 0.0025), {0.0, -1.0, 0.0}});
    ASSERT_NE(side.surface, nullptr);
    EXPECT_NEAR(side.range, 1.5, 1e-12);
}

TEST(BoardSolid, RoundHolesAreOpenAndHaveWalls) {
    const Target target = load_target("four_round_holes_aruco");
    const World world = board_alone(target);
    for (const Target::RoundHole& hole : target.round_holes)
        for (int i = 0; i < 16; ++i) {
            const double angle = 0.4 * i;
            const Eigen::Vector2d out(std::cos(angle), std::sin(angle));
            const Eigen::Vector2d in_place = hole.centre + (hole.radius - 1e-4) * out;
            const Eigen::Vector2d out_place = hole.centre + (hole.radius + 1e-4) * out;
            EXPECT_EQ(first(world, at_front(in_place.x(), in_place.y())).surface, nullptr);
            EXPECT_NE(first(world, at_front(out_place.x(), out_place.y())).surface, nullptr);
            // Outwards at 45 degrees from 1 mm inside the rim: the wall, 1 mm behind the front.
            const Eigen::Vector3d direction = Eigen::Vector3d(out.x(), out.y(), 1.0).normalized();
            const Eigen::Vector2d start = hole.centre + (hole.radius - 0.001 - 0.05) * out;
            const Hit wall =
                first(world, {Eigen::Vector3d(start.x(), start.y(), -0.05), direction});
            ASSERT_NE(wall.surface, nullptr);
            EXPECT_NEAR(wall.range, 0.051 * std::sqrt(2.0), 1e-9);
        }
}

TEST(BoardSolid, PrintsAreSeenByBothSensors) {
    const Target target = load_target("checkerboard");
    const auto front = board_texture(target);
    const Look dark = front->at({0.09, 0.10}), light = front->at({0.15, 0.10});
    EXPECT_FLOAT_EQ(dark.reflectivity, static_cast<float>(target.surface.dark_reflectivity));
    EXPECT_FLOAT_EQ(light.reflectivity, static_cast<float>(target.surface.reflectivity));
    EXPECT_LT(dark.colour.maxCoeff(), light.colour.minCoeff());
    EXPECT_FLOAT_EQ(front->at({0.03, 0.03}).reflectivity, light.reflectivity) << "the margin";
}

TEST(BoardSolid, ALookAlikeIsDarkWhereTheHolesAreAndHasNone) {
    const Target target = load_target("four_square_holes_500mm");
    const auto texture = look_alike_texture(target);
    for (const auto& hole : target.holes)
        EXPECT_LT(texture->at(0.5 * (hole[0] + hole[2])).colour.x(), 0.1F);
    EXPECT_GT(texture->at({0.25, 0.25}).colour.x(), 0.5F);
    EXPECT_LT(look_alike_texture(load_target("four_round_holes_aruco"))->at({0.45, 0.3}).colour.x(),
              0.1F);
}

TEST(BoardSolid, ABoardOfNoThicknessIsASheet) {
    Target target = load_target("four_square_holes_500mm");
    target.thickness = 0.0;
    EXPECT_EQ(board_alone(target).size(), 1U);
}

}  // namespace
}  // namespace petal::simulation
