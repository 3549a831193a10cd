// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "detectors/lidar_template.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <iterator>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "noise.hpp"
#include "petal/calibration/angles.hpp"
#include "petal/calibration/plane_fit.hpp"
#include "petal/calibration/se3.hpp"
#include "petal/calibration/target.hpp"
#include "petal/testing/stage_harness.hpp"
#include "plugins/detectors/ray_world.hpp"

namespace petal {
namespace {

using testing::facing_pose;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::normal;
using testing::RayWorld;
using ::testing::SizeIs;
using testing::StageHarness;
using testing::uniform;

StageHarness found_in(const Cloud& cloud, const std::string& target = "four_square_holes_500mm") {
    auto stage = StageHarness::of<LidarTemplate>();
    stage.set("target", target.c_str()).seed(3).give<Cloud>("cloud", cloud).fire();
    return stage;
}

/// The board that is found; none, which fails the test too, where there is not exactly one.
std::optional<LidarBoard> only_board(const RayWorld& world, Rng& rng) {
    auto stage = found_in(world.cast(rng), world.target);
    const auto& boards = stage.out<LidarBoards>("boards").boards;
    EXPECT_THAT(boards, SizeIs(1));
    if (boards.size() != 1) return std::nullopt;
    return boards[0];
}

/// Of the board's middle, and of its turn about its own axes; the nearest of `turns` like orders.
void expect_at(const LidarBoard& board, const Eigen::Isometry3d& truth, double metres,
               double degrees, int turns, const std::string& what) {
    const Target target = load_target(board.target);
    const Eigen::Vector3d middle(target.width() / 2.0, target.height() / 2.0, 0.0);
    EXPECT_LT((board.T_lidar_board * middle - truth * middle).norm(), metres) << what;
    double least = kPi;
    for (int k = 0; k < turns; ++k) {
        const Eigen::Matrix3d turned =
            truth.linear() *
            Eigen::AngleAxisd(2.0 * kPi * k / turns, Eigen::Vector3d::UnitZ()).toRotationMatrix();
        least = std::min(least, rotation_angle(turned.transpose() * board.T_lidar_board.linear()));
    }
    EXPECT_LT(least * kDegrees, degrees) << what;
}

// 60000 rays over 1.4 m square: 30000 a m^2, so some 10 for each mm of the holes' sides' 1.6 m
// within a mm of them: a side's place is known to about 0.1 mm, and 1 mm is far beyond it. Ranges:
// 10 mm over 6000 points. 0.3 deg: 1 mm over 0.2 m.
TEST(LidarTemplate, FindsABoardAtAnyDistanceAndAngle) {
    struct Case {
        double distance, yaw, pitch, roll;
    };
    for (const Case& c : {Case{2.0, 0.1, 0.05, 0.0}, Case{8.0, -0.1, 0.1, 0.05},
                          Case{3.0, 50.0 / kDegrees, 0.05, 0.0}, Case{3.0, 0.1, -0.2, 0.7}}) {
        Rng rng(1);
        RayWorld world;
        world.T_lidar_board = facing_pose(c.distance, c.yaw, c.pitch, c.roll);
        const auto board = only_board(world, rng);
        const std::string what = "at " + std::to_string(c.distance) + " m, yaw " +
                                 std::to_string(c.yaw) + ", roll " + std::to_string(c.roll);
        ASSERT_TRUE(board) << what;
        // A thin plate is no wall: obliquely the fit expects one of 4 mm that these rays lack.
        const double wall = 0.5 * 0.00425 * std::tan(std::abs(c.yaw));
        expect_at(*board, world.T_lidar_board, 0.001 + wall, 0.3, 4, what);
        ASSERT_TRUE(board->covariance);
        EXPECT_THAT(board->corners, SizeIs(16));
        // x to the right of an observer at the sensor: never more than an eighth of a turn off.
        const Eigen::Isometry3d seen =
            plane_frame(-board->T_lidar_board.linear().col(2), board->T_lidar_board.translation());
        EXPECT_GT(seen.linear().col(0).dot(board->T_lidar_board.linear().col(0)), 0.7) << what;
    }
}

/// The shipped board's target file, but as thin as foil.
std::string thin_target() {
    std::ifstream shipped(find_target_file("four_square_holes_500mm"));
    std::string text(std::istreambuf_iterator<char>(shipped), {});
    const std::string thickness = "\"thickness\": 0.005";
    text.replace(text.find(thickness), thickness.size(), "\"thickness\": 0.0");
    const std::string file = ::testing::TempDir() + "lidar_template_thin_target.json";
    std::ofstream(file) << text;
    return file;
}

// At 45 deg a wall of 5 mm stands 5 mm into the hole, from one side: its middle seems 2.5 mm off.
// The model takes 0.85 of a level wall, so 0.4 mm remain, and 0.1 mm of noise.
TEST(LidarTemplate, WallsOfTheHolesDoNotMoveABoardThatIsSeenObliquely) {
    RayWorld world;
    world.walls = 0.005;
    world.T_lidar_board = facing_pose(3.0, 45.0 / kDegrees, 0.0, 0.0);
    const Eigen::Vector3d middle(0.25, 0.25, 0.0);
    const auto off = [&](const std::string& target) {
        Rng rng(8);
        auto stage = found_in(world.cast(rng), target);
        const auto& boards = stage.out<LidarBoards>("boards").boards;
        EXPECT_THAT(boards, SizeIs(1));
        if (boards.size() != 1) return -1.0;
        return (boards[0].T_lidar_board * middle - world.T_lidar_board * middle).norm();
    };
    EXPECT_LT(off(world.target), 0.001);
    EXPECT_NEAR(off(thin_target()), 0.0025, 0.0007);
}

// Only hits exist: the density of rays must tell the edges. 0.3 mm of Poisson noise, so 1.5 mm.
TEST(LidarTemplate, FindsABoardBeforeTheSky) {
    Rng rng(2);
    RayWorld world;
    world.T_lidar_board = facing_pose(4.0, 0.2, 0.1, 0.1);
    world.gap = 0.0;
    const auto board = only_board(world, rng);
    ASSERT_TRUE(board);
    expect_at(*board, world.T_lidar_board, 0.0015, 0.4, 4, "sky");
    EXPECT_GT(board->quality.at("silent_rays"), 1000.0);
}

// A wall 7 cm behind: 7 sigma of range.
TEST(LidarTemplate, FindsABoardCloseBeforeAWall) {
    Rng rng(3);
    RayWorld world;
    world.T_lidar_board = facing_pose(3.0, 0.02, 0.02, 0.0);
    world.gap = 0.07;
    const auto board = only_board(world, rng);
    ASSERT_TRUE(board);
    expect_at(*board, world.T_lidar_board, 0.001, 0.3, 4, "wall");
}

// Either sign, without moving the board. 1 mm: prior and corners of the holes pull a little.
TEST(LidarTemplate, TellsTheShiftOfTheEdges) {
    for (const double shift : {-0.005, 0.004, 0.010}) {
        Rng rng(4);
        RayWorld world;
        world.T_lidar_board = facing_pose(3.0, 0.0, 0.0, 0.0);
        world.shift = shift;
        const auto board = only_board(world, rng);
        ASSERT_TRUE(board) << shift;
        expect_at(*board, world.T_lidar_board, 0.001, 0.3, 4, "shift");
        EXPECT_NEAR(board->quality.at("edge_shift_level_mm"), shift * 1e3, 1.0);
        EXPECT_NEAR(board->quality.at("edge_shift_upright_mm"), shift * 1e3, 1.0);
    }
}

TEST(LidarTemplate, AnyTargetFileWillDo) {
    Rng rng(5);
    RayWorld world;
    world.target = "four_round_holes_aruco";
    world.T_lidar_board = facing_pose(3.0, 0.2, 0.1, 0.05, 1.4, 1.0);
    const auto board = only_board(world, rng);
    ASSERT_TRUE(board);
    expect_at(*board, world.T_lidar_board, 0.0015, 0.2, 2, "round holes");
    EXPECT_THAT(board->corners, SizeIs(4)) << "centres of the holes";
}

TEST(LidarTemplate, APlateWithoutHolesIsNoBoard) {
    Rng rng(6);
    RayWorld world;
    world.T_lidar_board = facing_pose(3.0, 0.1, 0.1, 0.0);
    world.holes = false;
    auto stage = found_in(world.cast(rng));
    EXPECT_THAT(stage.out<LidarBoards>("boards").boards, IsEmpty());
    ASSERT_THAT(stage.notes(), SizeIs(1));
    EXPECT_THAT(stage.notes()[0].looked_for, HasSubstr("four_square_holes_500mm"));
    EXPECT_THAT(stage.notes()[0].nearest_miss, HasSubstr("agrees with the rays by 0."));
    EXPECT_THAT(stage.notes()[0].threshold, HasSubstr("0.40"));
}

// 5 % larger than its file: holes 10 mm farther apart.
TEST(LidarTemplate, ABoardOfOtherMeasuresIsAFinding) {
    Rng rng(7);
    RayWorld world;
    world.T_lidar_board = facing_pose(3.0, 0.1, 0.1, 0.0);
    world.scale = 1.05;
    auto stage = found_in(world.cast(rng));
    const LidarBoards& boards = stage.out<LidarBoards>("boards");
    EXPECT_THAT(boards.boards, IsEmpty());
    ASSERT_THAT(boards.findings, SizeIs(1)) << stage.notes()[0].nearest_miss;
    EXPECT_THAT(boards.findings[0], HasSubstr("farther apart than the target's"));
}

TEST(LidarTemplate, AnEmptyCloudAndOneOfNothingGetANote) {
    for (const int points : {0, 50}) {
        auto map = mrpt::maps::CPointsMapXYZI::Create();
        for (int i = 0; i < points; ++i)
            map->insertPoint(std::numeric_limits<float>::quiet_NaN(), 1.0F, 2.0F);
        Cloud cloud;
        cloud.points = map;
        auto stage = found_in(cloud);
        EXPECT_THAT(stage.out<LidarBoards>("boards").boards, IsEmpty());
        ASSERT_THAT(stage.notes(), SizeIs(1));
        EXPECT_FALSE(stage.notes()[0].hint.empty());
    }
}

/// Points on the sides of the holes alone, `off` m on the plate's side, 4 mm of noise.
Cloud edge_cloud(const Eigen::Isometry3d& pose, double off, Rng& rng) {
    const PlateTemplate plate(load_target("four_square_holes_500mm"));
    auto map = mrpt::maps::CPointsMapXYZI::Create();
    for (const PlateShape::SidePoint& side : plate.holes.along_sides(0.005, 0.0)) {
        const Eigen::Vector2d at = side.at + plate.holes.middle() + off * side.inward;
        const Eigen::Vector3d p =
            pose * Eigen::Vector3d(at.x() + normal(rng, 0.004), at.y() + normal(rng, 0.004),
                                   normal(rng, 0.004));
        map->insertPoint(static_cast<float>(p.x()), static_cast<float>(p.y()),
                         static_cast<float>(p.z()));
    }
    Cloud cloud;
    cloud.points = map;
    return cloud;
}

// 320 points of 4 mm: 0.3 mm along each axis; 3 mm is also beyond what a start half a cell off
// would leave. The points lie 10 mm inside the plate: holes look larger by that on each side.
TEST(LidarTemplate, PointsOnEdgesAloneWillDo) {
    for (const double roll : {0.0, 0.4}) {
        Rng rng(8);
        const Eigen::Isometry3d pose = facing_pose(3.0, 0.2, 0.1, roll);
        auto stage = found_in(edge_cloud(pose, 0.010, rng));
        const auto& boards = stage.out<LidarBoards>("boards").boards;
        ASSERT_THAT(boards, SizeIs(1)) << roll;
        expect_at(boards[0], pose, 0.003, 0.8, 4, "edges");
        // Rolled, an edge sees both axes at once.
        EXPECT_NEAR(boards[0].quality.at("edge_shift_level_mm"),
                    -10.0 / (std::cos(roll) + std::sin(roll)), 2.0);
    }
}

TEST(LidarTemplate, TheGradientIsThatOfTheLikelihood) {
    const PlateTemplate plate(load_target("four_square_holes_500mm"));
    PlateState state;
    state.T_lidar_middle =
        plane_frame(Eigen::Vector3d(-1.0, 0.3, 0.2).normalized(), {4.5, 0.5, 0.3});
    state.shift = {0.001, 0.004};
    state.log_width = {-6.1, -5.9};
    state.wall = {0.004, 0.001};
    state.glare = {0.001, 0.002};
    PlatePriors priors;
    Rng rng(9);
    ToldRays rays;
    for (int i = 0; i < 4000; ++i) {
        const Eigen::Vector3d p =
            state.T_lidar_middle *
            Eigen::Vector3d(uniform(rng, -0.21, 0.21), uniform(rng, -0.21, 0.21), 0.0);
        const bool on = plate.holes.edge((state.T_lidar_middle.inverse() * p).head<2>()).inside >
                        uniform(rng, 0.0, 0.004);
        rays.rays.push_back({p, on, uniform(rng, -1.0, 1.0)});
        if (i % 3 == 0) rays.silent.push_back({p, uniform(rng, 0.0, 1.0), on});
    }
    const PlateEvaluation at =
        evaluate_plate(plate.holes, state, priors, rays, PlateScores::left_out);
    for (int k = 0; k < kPlateParameters; ++k) {
        PlateVector step = PlateVector::Zero();
        step(k) = 1e-6;
        const double up =
            evaluate_plate(plate.holes, moved(state, step), priors, rays, PlateScores::left_out)
                .value;
        const double down =
            evaluate_plate(plate.holes, moved(state, -step), priors, rays, PlateScores::left_out)
                .value;
        // A turn also turns the beam's axes on the board, which the gradient leaves out.
        const double tolerance = k >= kPhiX && k <= kPhiZ ? 0.35 : 0.02;
        EXPECT_NEAR(at.gradient(k), (up - down) / 2e-6, tolerance * std::abs(at.gradient(k)) + 1.0)
            << k;
    }
}

}  // namespace
}  // namespace petal
