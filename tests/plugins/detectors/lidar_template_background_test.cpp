// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "detectors/detail/lidar_template_background.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "detectors/lidar_template.hpp"
#include "petal/testing/stage_harness.hpp"
#include "plugins/detectors/ray_world.hpp"

namespace petal {
namespace {

using testing::facing_pose;
using testing::RayWorld;
using ::testing::SizeIs;
using testing::StageHarness;

/// 3 m away; a dark stripe begins 12 mm above the lower sides of the lower holes.
RayWorld with_skirting() {
    RayWorld world;
    world.T_lidar_board = facing_pose(3.0, 0.1, 0.05, 0.0);
    world.dark_from = 0.138;
    world.darkness = 1.2;
    return world;
}

/// The rays of a world in the plane of its board.
RayBundle rays_of(const RayWorld& world, const PlateTemplate& target) {
    Rng rng(4);
    const Eigen::Isometry3d middle =
        world.T_lidar_board *
        Eigen::Translation3d(target.all.middle().x(), target.all.middle().y(), 0.0);
    const Cloud cloud = world.cast(rng);
    RayBundle rays = gather_rays(CloudDirections(cloud), middle, 1.2 * target.all.radius());
    rays.hit_depth = 0.03;
    return rays;
}

TEST(LidarTemplateBackground, SidesBeforeADarkStripeAreToldFromTheOthers) {
    const PlateTemplate target(load_target("four_square_holes_500mm"));
    const PlateShape& shape = target.holes;
    const std::vector<double> found = backgrounds_of(shape, rays_of(with_skirting(), target));
    ASSERT_THAT(found, SizeIs(shape.side_count()));
    std::vector<double> lowest(shape.side_count(), -1.0);
    for (const PlateShape::SidePoint& p : shape.along_sides(0.01, 0.02))
        lowest[static_cast<std::size_t>(p.side)] = p.at.y();
    // The lowest two of sixteen sides are 1.2 darker than the others, of four of which the lowest
    // 12 of 100 mm are dark too: the mean is 0.19 darker than most. Of what is left 0.15 count as
    // alike.
    const double mean = 1.2 * (2.0 + 4.0 * 0.12) / 16.0;
    for (std::size_t s = 0; s < found.size(); ++s) {
        if (lowest[s] > 0.145)
            EXPECT_NEAR(found[s], -(1.2 - mean - 0.15), 0.05);
        else
            EXPECT_NEAR(found[s], 0.5 * (mean - 0.15), 0.5 * (mean - 0.15) + 0.03);
    }
}

TEST(LidarTemplateBackground, WhereNothingReturnsNothingIsTold) {
    const PlateTemplate target(load_target("four_square_holes_500mm"));
    RayWorld world = with_skirting();
    world.gap = 0.0;
    for (const double brightness : backgrounds_of(target.holes, rays_of(world, target)))
        EXPECT_EQ(brightness, 0.0);
}

TEST(LidarTemplateBackground, AnIntensityThatIsNoNumberOrNothingIsDark) {
    const PlateTemplate target(load_target("four_square_holes_500mm"));
    RayWorld world = with_skirting();
    Rng rng(4);
    Cloud cloud = world.cast(rng);
    auto broken = mrpt::maps::CPointsMapXYZI::Create(*cloud.points);
    for (std::size_t i = 0; i < broken->size(); ++i)
        broken->setPointIntensity(i, i % 3 == 0 ? std::nanf("") : i % 3 == 1 ? -1.0F : 0.0F);
    cloud.points = broken;
    const RayBundle rays = gather_rays(CloudDirections(cloud), world.T_lidar_board, 1.0);
    ASSERT_FALSE(rays.rays.empty());
    EXPECT_TRUE(std::all_of(rays.rays.begin(), rays.rays.end(), [](const PlaneRay& ray) {
        return ray.log_energy == std::log(1e-3 / ray.point.squaredNorm());
    }));
}

// Two of the eight level sides look 3.6 mm higher: left alone the board would move by a quarter of
// that, 0.9 mm, and more. Sides are known to 0.1 mm each; of the upright sides' lowest 12 mm, which
// are dark too, the mean counts.
TEST(LidarTemplateBackground, ADarkStripeBehindSomeSidesDoesNotMoveTheBoard) {
    RayWorld world = with_skirting();
    world.glare = 0.003;
    const auto too_high = [&] {
        Rng rng(4);
        auto stage = StageHarness::of<LidarTemplate>();
        stage.seed(3).give<Cloud>("cloud", world.cast(rng)).fire();
        const auto& boards = stage.out<LidarBoards>("boards").boards;
        EXPECT_THAT(boards, SizeIs(1));
        if (boards.size() != 1) return -1.0;
        const Eigen::Vector3d middle(0.25, 0.25, 0.0);
        return -(world.T_lidar_board.inverse() * (boards[0].T_lidar_board * middle) - middle).y();
    };
    EXPECT_NEAR(too_high(), 0.0, 0.0003);
    world.intensities = false;
    EXPECT_GT(too_high(), 0.0006);
}

}  // namespace
}  // namespace petal
