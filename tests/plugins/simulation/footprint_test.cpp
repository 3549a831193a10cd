// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulation/lidar/footprint.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "plugins/simulation/lidar_worlds.hpp"

namespace petal::simulation {
namespace {

const Eigen::Vector3d kUp = Eigen::Vector3d::UnitZ();

/// Along the x axis, turned a little: `left` and `up` m at `range`.
Ray beam_to(double range, double left, double up) {
    return {Eigen::Vector3d::Zero(), Eigen::Vector3d(range, left, up).normalized()};
}

/// A half-plane at `range`: everything that is left of the x axis, or above it.
World half_plane(double range, bool above, float reflectivity = 0.5F) {
    World world;
    const Eigen::Vector3d corner =
        above ? Eigen::Vector3d(range, 5.0, 10.0) : Eigen::Vector3d(range, 10.0, 5.0);
    world.add(std::make_unique<PlanarSurface>(before_lidar(corner),
                                              PlanarSurface::rectangle(10.0, 10.0),
                                              reflecting(reflectivity), Kind::board));
    world.build();
    return world;
}

double share_of_first(const World& world, const LidarProfile& profile, const Ray& beam) {
    Footprint footprint(world, profile);
    const std::vector<Patch> patches = footprint.meet(beam, kUp);
    return patches.empty() ? 0.0 : patches.front().share;
}

TEST(FootprintTest, OnOneSurfaceItIsOnePatch) {
    World world;
    add_wall(world, 5.0, 10.0, 0.5F);
    world.build();
    Footprint footprint(world, load_lidar_profile("livox_mid70"));
    const auto& patches = footprint.meet(beam_to(5.0, 0.0, 0.0), kUp);
    ASSERT_EQ(patches.size(), 1U);
    EXPECT_DOUBLE_EQ(patches[0].range, 5.0);
    EXPECT_DOUBLE_EQ(patches[0].share, 1.0);
    EXPECT_NEAR(patches[0].energy, 0.5 / 25.0, 1e-6);  // the ends of the footprint: 3e-6 of it less
    // Slanted: the energy falls with the cosine, and with the range.
    const auto& slanted = footprint.meet(beam_to(5.0, 5.0 * std::sqrt(3.0) / 2.0, 0.0), kUp);
    ASSERT_EQ(slanted.size(), 1U);
    const double range = std::hypot(5.0, 5.0 * std::sqrt(3.0) / 2.0);
    EXPECT_NEAR(slanted[0].range, range, 1e-9);
    EXPECT_NEAR(slanted[0].energy, 0.5 * 5.0 / range / (range * range), 1e-6);
}

TEST(FootprintTest, MeetsNothingInTheSkyOrTooFarAway) {
    World world;
    add_wall(world, 300.0, 100.0, 0.5F);
    world.build();
    Footprint footprint(world, load_lidar_profile("livox_mid70"));
    EXPECT_TRUE(footprint.meet(beam_to(5.0, 5.0, 0.0), kUp).empty());
    EXPECT_TRUE(footprint.meet(beam_to(5.0, 0.0, 0.0), kUp).empty()) << "range_max is 260 m";
}

// The footprint of 0.28 x 0.03 deg is 24.4 mm high and 2.6 mm wide at 5 m.
TEST(FootprintTest, AtAnEdgeTheSharesAreThoseOfTheRectangle) {
    const LidarProfile profile = load_lidar_profile("livox_mid70");
    const double height = 5.0 * profile.footprint_vertical;
    const double width = 5.0 * profile.footprint_horizontal;
    const World above = half_plane(5.0, true), left = half_plane(5.0, false);
    for (const double part : {0.05, 0.25, 0.5, 0.8, 0.97}) {
        // Half a line of the grid of 57 x 9.
        EXPECT_NEAR(share_of_first(above, profile, beam_to(5.0, 0.0, (part - 0.5) * height)), part,
                    0.5 / 57.0 + 1e-6);
        EXPECT_NEAR(share_of_first(left, profile, beam_to(5.0, (part - 0.5) * width, 0.0)), part,
                    0.5 / 9.0 + 1e-6);
    }
    EXPECT_EQ(share_of_first(above, profile, beam_to(5.0, 0.0, -0.51 * height)), 0.0);
    EXPECT_EQ(share_of_first(left, profile, beam_to(5.0, -0.51 * width, 0.0)), 0.0);
    EXPECT_DOUBLE_EQ(share_of_first(left, profile, beam_to(5.0, 0.51 * width, 0.0)), 1.0);
}

TEST(FootprintTest, AWideBeamIsWide) {
    const LidarProfile profile = load_lidar_profile("spinning_32");  // 0.09 x 0.18 deg
    const double width = 5.0 * profile.footprint_horizontal;
    const World left = half_plane(5.0, false);
    for (const double part : {0.1, 0.5, 0.9})
        EXPECT_NEAR(share_of_first(left, profile, beam_to(5.0, (part - 0.5) * width, 0.0)), part,
                    0.5 / 57.0 + 1e-6);
}

TEST(FootprintTest, TurnsWithTheSensor) {
    const LidarProfile profile = load_lidar_profile("livox_mid70");
    const World left = half_plane(5.0, false);
    Footprint footprint(left, profile);
    // On its side it is 24.4 mm wide: 6 mm right of the edge a quarter of it is still on the
    // surface.
    const auto& patches = footprint.meet(beam_to(5.0, -0.0061, 0.0), Eigen::Vector3d::UnitY());
    ASSERT_EQ(patches.size(), 1U);
    EXPECT_NEAR(patches[0].share, 0.25, 0.01);
}

TEST(FootprintTest, TwoSurfacesAreTwoPatchesNearestFirst) {
    World world;
    add_wall(world, 5.0, 10.0, 0.8F, Kind::board);
    add_wall(world, 6.0, 100.0, 0.5F);
    world.build();
    Footprint footprint(world, load_lidar_profile("livox_mid70"));
    // The upper rim of the first.
    const auto& patches = footprint.meet(beam_to(5.0, 0.0, 5.0), kUp);
    ASSERT_GE(patches.size(), 2U);
    double shares = 0.0;
    for (std::size_t i = 0; i < patches.size(); ++i) {
        shares += patches[i].share;
        EXPECT_GE(patches[i].range, patches[i > 0 ? i - 1 : 0].range);
        EXPECT_LE(patches[i].farthest - patches[i].nearest, 0.05 + 1e-12);
    }
    EXPECT_NEAR(shares, 1.0, 1e-9);
    EXPECT_EQ(patches.front().surface->kind(), Kind::board);
    EXPECT_EQ(patches.back().surface->kind(), Kind::background);
}

TEST(FootprintTest, NeighboursInOnePlaneCountAsOneSurface) {
    World tiles;
    for (const double top : {5.0, 0.0})  // they meet on the x axis
        tiles.add(std::make_unique<PlanarSurface>(before_lidar({5.0, 2.5, top}),
                                                  PlanarSurface::rectangle(5.0, 5.0),
                                                  reflecting(0.5F), Kind::background));
    tiles.build();
    Footprint footprint(tiles, load_lidar_profile("livox_mid70"));
    const auto& patches = footprint.meet(beam_to(5.0, 0.0, 0.003), kUp);
    ASSERT_EQ(patches.size(), 1U);
    EXPECT_DOUBLE_EQ(patches[0].share, 1.0);
}

}  // namespace
}  // namespace petal::simulation
