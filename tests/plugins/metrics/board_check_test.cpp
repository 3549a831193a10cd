// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "metrics/board_check.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <optional>

#include "metrics/detail/other_plate.hpp"
#include "petal/testing/stage_harness.hpp"
#include "plugins/metrics/plate_world.hpp"

namespace petal {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using testing::PlateWorld;
using testing::StageHarness;

StageHarness check(const PlateWorld& world, const LidarBoards& boards) {
    auto stage = StageHarness::of<BoardCheck>("metric.board_check");
    stage.give<Cloud>("cloud", world.cloud(), "hall");
    stage.give<LidarBoards>("boards", boards, "hall");
    return stage;
}

double shape_figure(const StageHarness& stage, const std::string& name) {
    for (const Metric& metric : stage.out<Metrics>("metrics").values)
        if (metric.name == "board_check." + name && metric.scene == "hall") return metric.value;
    ADD_FAILURE() << "no " << name;
    return 0.0;
}

const std::vector<Finding>& found(const StageHarness& stage) {
    return stage.out<Metrics>("metrics").findings;
}

TEST(BoardCheckStage, ARightBoardHasTheTargetsMeasures) {
    const PlateWorld world;
    auto stage = check(world, world.boards());
    stage.fire();
    EXPECT_TRUE(found(stage).empty());
    EXPECT_NEAR(shape_figure(stage, "board_1.noise_mm"), 10.0, 0.5);
    EXPECT_LT(shape_figure(stage, "board_1.flatness_mm"),
              0.6);  // 12 points a patch and more: 10 mm / sqrt(900)
    for (const char* axis : {"board_1.pitch_x", "board_1.pitch_y"})
        EXPECT_LT(std::abs(shape_figure(stage, axis + std::string("_percent"))),
                  4.0 * shape_figure(stage, axis + std::string("_sigma_percent")));
    EXPECT_NEAR(shape_figure(stage, "board_1.width_mm"), 500.0,
                4.0 * shape_figure(stage, "board_1.width_sigma_mm"));
    EXPECT_NEAR(shape_figure(stage, "board_1.height_mm"), 500.0,
                4.0 * shape_figure(stage, "board_1.height_sigma_mm"));
    EXPECT_LT(shape_figure(stage, "board_1.width_sigma_mm"), 3.0);
}

TEST(BoardCheckStage, ABentBoardIsNamed) {
    PlateWorld world;
    world.bow = 0.012;
    auto stage = check(world, world.boards());
    stage.fire();
    ASSERT_EQ(found(stage).size(), 1U);
    EXPECT_THAT(found(stage)[0].reason, HasSubstr("hall: board 1 is bent: a bow of 1"));
    EXPECT_NEAR(shape_figure(stage, "board_1.bow_mm"), 12.0, 1.5);
}

TEST(BoardCheckStage, HolesThatStandNearerThanTheFileSaysAreNamed) {
    PlateWorld world;
    const LidarBoards boards = world.boards();  // the target's pose and pattern
    world.target = scaled(world.target, 0.96);  // 10 mm narrower on either side
    auto stage = check(world, boards);
    stage.fire();
    ASSERT_FALSE(found(stage).empty());
    EXPECT_EQ(found(stage)[0].level, Level::not_usable);
    EXPECT_THAT(found(stage)[0].reason,
                AllOf(HasSubstr("nearer to each other in x"),
                      HasSubstr("the target file 'four_square_holes_500mm'")));
    EXPECT_NEAR(shape_figure(stage, "board_1.pitch_x_percent"), -4.0, 0.8);
}

/// The plane of the plate, from some of its points.
Planes plane_of(const PlateWorld& world) {
    Plane plane;
    const Eigen::Isometry3d T = PlateWorld::T_lidar_board();
    plane.normal = -T.linear().col(2);
    plane.offset = -plane.normal.dot(T.translation());
    auto map = std::make_shared<mrpt::maps::CPointsMapXYZI>();
    for (const Eigen::Vector2d& p : world.target.outline) {
        const Eigen::Vector3f q = (T * Eigen::Vector3d(p.x(), p.y(), 0.0)).cast<float>();
        map->insertPointFast(q.x(), q.y(), q.z());
    }
    plane.inliers.points = map;
    return Planes{{plane}};
}

TEST(BoardCheckStage, ABoardOfAnotherSizeIsNamedThoughNoDetectorFoundIt) {
    PlateWorld world;
    world.target = scaled(world.target, 0.9);
    auto stage = check(world, LidarBoards{"LIDAR", {}});
    stage.give<Planes>("planes", plane_of(world), "hall");
    stage.fire();
    ASSERT_EQ(found(stage).size(), 1U);
    EXPECT_THAT(found(stage)[0].reason,
                AllOf(HasSubstr("hall: a plate of 0.45 x 0.45 m"), HasSubstr("stands at 3.0 m"),
                      HasSubstr("'four_square_holes_500mm' says 0.50 x 0.50 m")));
    EXPECT_NEAR(shape_figure(stage, "other_plate_1.width_mm"), 450.0, 5.0);
}

TEST(BoardCheckStage, APlateWithoutHolesIsNoBoardOfAnotherSize) {
    PlateWorld world;
    world.target = scaled(world.target, 0.9);
    world.target.holes.clear();
    auto stage = check(world, LidarBoards{"LIDAR", {}});
    stage.give<Planes>("planes", plane_of(world), "hall");
    stage.fire();
    EXPECT_TRUE(found(stage).empty());
    EXPECT_TRUE(stage.notes().empty());
}

TEST(BoardCheckStage, ABoardThatWasFoundIsNotLookedForAgain) {
    const PlateWorld world;
    auto stage = check(world, world.boards());
    stage.give<Planes>("planes", plane_of(world), "hall");
    stage.fire();
    EXPECT_TRUE(found(stage).empty());
    EXPECT_TRUE(stage.notes().empty());
}

}  // namespace
}  // namespace petal
