// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulation/world/world.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <random>

#include "noise.hpp"
#include "simulation/world/surfaces.hpp"

namespace petal::simulation {
namespace {

using petal::testing::uniform;

std::shared_ptr<const Texture> plain_world_look() {
    return std::make_shared<PlainTexture>(Look{});
}

/// A square of `size` m about (x, 0, 0), facing the origin, with a hole of half its size.
std::unique_ptr<Surface> holed_square(double x, double size) {
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    pose.linear() << 0, 0, 1, -1, 0, 0, 0, -1, 0;
    pose.translation() = Eigen::Vector3d(x, size / 2, size / 2);
    auto shape = PlanarSurface::rectangle(size, size);
    const double a = size / 4, b = 3 * size / 4;
    shape.holes.push_back({{a, a}, {b, a}, {b, b}, {a, b}});
    return std::make_unique<PlanarSurface>(pose, shape, plain_world_look(), Kind::board);
}

Eigen::Vector3d random_direction(Rng& rng) {
    for (;;) {
        const Eigen::Vector3d v(uniform(rng, -1, 1), uniform(rng, -1, 1), uniform(rng, -1, 1));
        if (v.norm() > 0.1 && v.norm() < 1.0) return v.normalized();
    }
}

TEST(WorldTest, ARayMeetsTheNearestSurfaceAndPassesThroughHoles) {
    World world;
    world.add(holed_square(2.0, 1.0));
    world.add(holed_square(3.0, 4.0));
    world.build();
    const Ray middle{Eigen::Vector3d::Zero(), Eigen::Vector3d::UnitX()};
    EXPECT_EQ(world.cast(middle, 100.0).surface, nullptr) << "both holes lie on the axis";
    // 0.4 m to the left at 2 m: on the first one's frame.
    const Ray beside{Eigen::Vector3d::Zero(), Eigen::Vector3d(2.0, 0.4, 0.0).normalized()};
    const Hit hit = world.cast(beside, 100.0);
    ASSERT_NE(hit.surface, nullptr);
    EXPECT_DOUBLE_EQ(hit.range, std::hypot(2.0, 0.4));
    EXPECT_NEAR(hit.place.x(), 0.1, 1e-12);
    EXPECT_NEAR(hit.place.y(), 0.5, 1e-12);
    EXPECT_LT(hit.normal.dot(beside.direction), 0.0) << "the normal faces the ray's origin";
    EXPECT_EQ(world.cast(beside, 1.9).surface, nullptr) << "farther than asked for";
    EXPECT_TRUE(world.blocked(beside, 100.0));
    EXPECT_FALSE(world.blocked(middle, 100.0));
}

TEST(WorldTest, AnEmptyWorldHasNothing) {
    World world;
    world.build();
    EXPECT_EQ(world.cast({Eigen::Vector3d::Zero(), Eigen::Vector3d::UnitX()}, 1e3).surface,
              nullptr);
}

TEST(WorldTest, ARayAlongAFaceOfABoxIsNotLost) {
    // An upright sheet whose lower edge lies at the height of a level ray, seen from all sides.
    for (const double sign : {1.0, -1.0}) {
        World world;
        Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
        pose.linear() << 0, 0, -1, 1, 0, 0, 0, -1, 0;
        pose.translation() = Eigen::Vector3d(2.0 * sign, -1.0, 1.0);
        world.add(std::make_unique<PlanarSurface>(pose, PlanarSurface::rectangle(2.0, 1.0),
                                                  plain_world_look(), Kind::background));
        world.build();
        for (const double zero : {0.0, -0.0}) {
            Hit alone;
            const Ray ray{Eigen::Vector3d::Zero(), Eigen::Vector3d(sign, zero, zero)};
            PlanarSurface(pose, PlanarSurface::rectangle(2.0, 1.0), plain_world_look(),
                          Kind::background)
                .cast(ray, alone);
            EXPECT_EQ(world.cast(ray, 10.0).surface != nullptr, alone.surface != nullptr);
            EXPECT_NE(alone.surface, nullptr);
        }
    }
}

TEST(WorldTest, TheTreeFindsWhatTryingEverySurfaceFinds) {
    Rng rng(3);
    World world;
    std::vector<std::unique_ptr<Surface>> all;
    for (int i = 0; i < 60; ++i) {
        Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
        pose.linear() =
            Eigen::AngleAxisd(uniform(rng, 0, 3), random_direction(rng)).toRotationMatrix();
        // Every fourth lies along the axes, where a box of no thickness is met edge on.
        if (i % 4 == 0) pose.linear().setIdentity();
        pose.translation() =
            Eigen::Vector3d(uniform(rng, -5, 5), uniform(rng, -5, 5), uniform(rng, -5, 5));
        const double size = uniform(rng, 0.1, 3.0);
        const auto make = [&]() -> std::unique_ptr<Surface> {
            if (i % 5 == 0)
                return std::make_unique<CylinderSurface>(pose, size / 4, size, plain_world_look(),
                                                         Kind::foreground);
            return std::make_unique<PlanarSurface>(pose, PlanarSurface::rectangle(size, 1.0),
                                                   plain_world_look(), Kind::background);
        };
        world.add(make());
        all.push_back(make());
    }
    world.build();
    int met = 0;
    for (int i = 0; i < 5000; ++i) {
        // Some rays along an axis: their inverse direction is infinite.
        const Eigen::Vector3d direction = i % 10 == 0
                                              ? Eigen::Vector3d(Eigen::Vector3d::Unit(i / 10 % 3))
                                              : random_direction(rng);
        const Ray ray{{uniform(rng, -6, 6), uniform(rng, -6, 6), uniform(rng, -6, 6)}, direction};
        Hit expected;
        for (const auto& surface : all) surface->cast(ray, expected);
        const Hit hit = world.cast(ray, std::numeric_limits<double>::infinity());
        ASSERT_EQ(hit.surface == nullptr, expected.surface == nullptr) << "ray " << i;
        ASSERT_EQ(world.blocked(ray, 1e6), expected.surface != nullptr) << "ray " << i;
        if (hit.surface == nullptr) continue;
        ASSERT_EQ(hit.range, expected.range) << "ray " << i;
        ++met;
    }
    EXPECT_GT(met, 500) << "too few of the rays meet anything to prove much";
}

TEST(SurfacesTest, ACylinderIsMetOutsideAndFromWithin) {
    const CylinderSurface pole(Eigen::Isometry3d::Identity(), 0.5, 2.0, plain_world_look(),
                               Kind::foreground);
    Hit hit;
    ASSERT_TRUE(pole.cast({{-3.0, 0.0, 1.0}, Eigen::Vector3d::UnitX()}, hit));
    EXPECT_DOUBLE_EQ(hit.range, 2.5);
    EXPECT_TRUE(hit.normal.isApprox(-Eigen::Vector3d::UnitX()));
    hit = {};
    ASSERT_TRUE(pole.cast({{0.0, 0.0, 1.0}, Eigen::Vector3d::UnitX()}, hit));
    EXPECT_DOUBLE_EQ(hit.range, 0.5);
    EXPECT_TRUE(hit.normal.isApprox(-Eigen::Vector3d::UnitX()));
    hit = {};
    EXPECT_FALSE(pole.cast({{-3.0, 0.0, 2.1}, Eigen::Vector3d::UnitX()}, hit)) << "above it";
    EXPECT_FALSE(pole.cast({{0.0, 0.0, 1.0}, Eigen::Vector3d::UnitZ()}, hit)) << "along its axis";
}

TEST(SurfacesTest, ARoundHoleIsRound) {
    auto shape = PlanarSurface::rectangle(1.0, 1.0);
    shape.round_holes.push_back({{0.5, 0.5}, 0.2});
    const PlanarSurface plate(Eigen::Isometry3d::Identity(), shape, plain_world_look(),
                              Kind::board);
    for (int degree = 0; degree < 360; degree += 7) {
        const double angle = degree * 0.0174532925;
        for (const double radius : {0.1999, 0.2001}) {
            Hit hit;
            const Ray down{{0.5 + radius * std::cos(angle), 0.5 + radius * std::sin(angle), 1.0},
                           -Eigen::Vector3d::UnitZ()};
            EXPECT_EQ(plate.cast(down, hit), radius > 0.2) << degree;
        }
    }
}

TEST(SurfacesTest, AnOutlineNeedNotBeARectangle) {
    const PlanarSurface triangle(Eigen::Isometry3d::Identity(),
                                 {{{0.0, 0.0}, {1.0, 0.0}, {0.0, 1.0}}, {}, {}}, plain_world_look(),
                                 Kind::board);
    Hit hit;
    EXPECT_TRUE(triangle.cast({{0.3, 0.3, 1.0}, -Eigen::Vector3d::UnitZ()}, hit));
    hit = {};
    EXPECT_FALSE(triangle.cast({{0.7, 0.7, 1.0}, -Eigen::Vector3d::UnitZ()}, hit));
}

}  // namespace
}  // namespace petal::simulation
