// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "detectors/board_lines.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>

#include "detectors/detail/board_line_finder.hpp"
#include "detectors/planes_ransac.hpp"
#include "noise.hpp"
#include "petal/calibration/angles.hpp"
#include "petal/calibration/plane_fit.hpp"
#include "petal/calibration/se3.hpp"
#include "petal/calibration/target.hpp"
#include "petal/testing/stage_harness.hpp"

namespace petal {
namespace {

using ::testing::HasSubstr;
using testing::normal;
using testing::StageHarness;
using testing::uniform;

Cloud to_cloud(const std::vector<Eigen::Vector3d>& points) {
    auto map = mrpt::maps::CPointsMapXYZI::Create();
    for (const auto& p : points)
        map->insertPoint(static_cast<float>(p.x()), static_cast<float>(p.y()),
                         static_cast<float>(p.z()));
    Cloud cloud;
    cloud.points = map;
    return cloud;
}

Eigen::Isometry3d board_pose(double turn, double tilt) {
    const Eigen::Vector3d facing = Eigen::AngleAxisd(tilt, Eigen::Vector3d::UnitZ()) *
                                   Eigen::Vector3d(-1.0, 0.0, 0.1).normalized();
    return plane_frame(facing, {3.0, 0.5, -0.2}) *
           Eigen::AngleAxisd(turn, Eigen::Vector3d::UnitZ()) *
           Eigen::Translation3d(-0.25, -0.25, 0.0);
}

/// Margin points of a board: rims of the holes enlarged by `inflation`, the outer edges, 4 mm
/// noise.
std::vector<Eigen::Vector3d> board_points(const Eigen::Isometry3d& pose, double inflation, Rng& rng,
                                          bool holes = true) {
    std::vector<Eigen::Vector3d> points;
    const auto side = [&](const Eigen::Vector2d& a, const Eigen::Vector2d& b, int count) {
        for (int i = 0; i < count; ++i) {
            const Eigen::Vector2d p = a + (b - a) * uniform(rng, 0.0, 1.0);
            points.push_back(pose * Eigen::Vector3d(p.x() + normal(rng, 0.004),
                                                    p.y() + normal(rng, 0.004),
                                                    normal(rng, 0.004)));
        }
    };
    const auto rim = [&](double x0, double y0, double x1, double y1, int count) {
        side({x0, y0}, {x1, y0}, count);
        side({x1, y0}, {x1, y1}, count);
        side({x1, y1}, {x0, y1}, count);
        side({x0, y1}, {x0, y0}, count);
    };
    rim(0.0, 0.0, 0.5, 0.5, 60);
    if (!holes) return points;
    for (const double x : {0.1, 0.3})
        for (const double y : {0.1, 0.3})
            rim(x - inflation, y - inflation, x + 0.1 + inflation, y + 0.1 + inflation, 14);
    return points;
}

void add_clutter(std::vector<Eigen::Vector3d>& points, int count, Rng& rng) {
    for (int i = 0; i < count; ++i)
        points.emplace_back(uniform(rng, 2.0, 4.0), uniform(rng, -1.5, 1.5),
                            uniform(rng, -1.0, 0.5));
}

/// planes_ransac, then board_lines; both with `seed`.
StageHarness detect(const Cloud& cloud, std::uint64_t seed, bool spacing = true) {
    auto planes = StageHarness::of<PlanesRansac>();
    planes.seed(seed).give<Cloud>("cloud", cloud).fire();
    auto boards = StageHarness::of<BoardLines>();
    boards.set("use_target_spacing", Value(spacing)).seed(seed);
    boards.give<Cloud>("cloud", cloud).give<Planes>("planes", planes.out<Planes>("planes")).fire();
    return boards;
}

/// A board hung close before a wall: the left and right sides are whole, of the upper and lower
/// ones there are pieces.
std::vector<Eigen::Vector3d> board_on_a_wall(const Eigen::Isometry3d& pose, Rng& rng) {
    std::vector<Eigen::Vector3d> points;
    const auto piece = [&](const Eigen::Vector2d& a, const Eigen::Vector2d& b, int count) {
        for (int i = 0; i < count; ++i) {
            const Eigen::Vector2d p = a + (b - a) * uniform(rng, 0.0, 1.0);
            points.push_back(pose * Eigen::Vector3d(p.x() + normal(rng, 0.004),
                                                    p.y() + normal(rng, 0.004),
                                                    normal(rng, 0.004)));
        }
    };
    piece({0.0, 0.0}, {0.0, 0.5}, 100);
    piece({0.5, 0.0}, {0.5, 0.5}, 200);
    for (const double x : {0.09, 0.21, 0.29, 0.41})
        for (const double y : {0.1, 0.3}) piece({x, y}, {x, y + 0.1}, 35);
    piece({0.12, 0.09}, {0.2, 0.09}, 30);    // upper sides
    piece({0.36, 0.29}, {0.41, 0.29}, 20);   //
    piece({0.18, 0.21}, {0.21, 0.21}, 8);    // lower sides
    piece({0.33, 0.21}, {0.35, 0.21}, 10);   //
    piece({0.39, 0.21}, {0.41, 0.21}, 10);   //
    piece({0.18, 0.41}, {0.21, 0.41}, 10);   //
    piece({0.29, 0.405}, {0.37, 0.41}, 30);  //
    return points;
}

// Corners of the holes once counted as points of sides that had none, and the board was placed by
// its lower sides alone, 2 cm off, with a sigma of 1 mm. 3 mm: three sigma of the pieces.
TEST(BoardLines, SidesWithoutPointsDoNotShiftABoard) {
    int found = 0;
    for (std::uint64_t seed = 1; seed <= 10; ++seed) {
        Rng rng(seed);
        const Eigen::Isometry3d truth = board_pose(0.0, 0.1);
        auto stage = detect(to_cloud(board_on_a_wall(truth, rng)), seed);
        for (const LidarBoard& board : stage.out<LidarBoards>("boards").boards) {
            ++found;
            EXPECT_LT((board.T_lidar_board * Eigen::Vector3d(0.25, 0.25, 0.0) -
                       truth * Eigen::Vector3d(0.25, 0.25, 0.0))
                          .norm(),
                      0.003)
                << "seed " << seed;
        }
    }
    EXPECT_GE(found, 5) << "half of them have points enough";
}

TEST(BoardLines, FindsTheKnownPoseAndTheInflation) {
    Rng rng(1);
    for (const double turn : {0.0, 0.3, -0.6}) {
        const Eigen::Isometry3d truth = board_pose(turn, 0.3);
        auto points = board_points(truth, 0.010, rng);
        add_clutter(points, 150, rng);
        auto stage = detect(to_cloud(points), 3);
        const auto& boards = stage.out<LidarBoards>("boards").boards;
        ASSERT_EQ(boards.size(), 1u) << "turn " << turn;
        const LidarBoard& board = boards[0];
        EXPECT_EQ(board.target, "four_square_holes_500mm");
        const Vector6d error = se3_log(board.T_lidar_board * truth.inverse());
        // 4 mm over some 100 points a direction: 0.4 mm; over 0.15 m of lever: 0.15 deg. Five
        // sigma.
        EXPECT_LT((board.T_lidar_board * Eigen::Vector3d(0.25, 0.25, 0.0) -
                   truth * Eigen::Vector3d(0.25, 0.25, 0.0))
                      .norm(),
                  0.002);
        EXPECT_LT(error.tail<3>().norm(), 0.8 * kPi / 180.0);
        EXPECT_NEAR(board.quality.at("edge_inflation_x_mm"), 10.0, 2.0);
        EXPECT_NEAR(board.quality.at("edge_inflation_y_mm"), 10.0, 2.0);
        // The corners are the target's, in its order, and rigid.
        const auto corners = load_target("four_square_holes_500mm").corners();
        ASSERT_EQ(board.corners.size(), corners.size());
        for (std::size_t i = 0; i < corners.size(); ++i)
            EXPECT_LT((board.corners[i] -
                       board.T_lidar_board * Eigen::Vector3d(corners[i].x(), corners[i].y(), 0.0))
                          .norm(),
                      1e-9);
        EXPECT_GT(board.T_lidar_board.linear().col(2).dot(board.T_lidar_board.translation()), 0.0)
            << "z points away from the sensor";
        EXPECT_LT(board.T_lidar_board.linear()(2, 1), -0.7) << "y points down";
    }
}

TEST(BoardLines, HolesThatAreTooSmallAreTakenUpToo) {
    Rng rng(2);
    const Eigen::Isometry3d truth = board_pose(0.1, 0.0);
    auto stage = detect(to_cloud(board_points(truth, -0.012, rng)), 1);
    const auto& boards = stage.out<LidarBoards>("boards").boards;
    ASSERT_EQ(boards.size(), 1u);
    EXPECT_NEAR(boards[0].quality.at("edge_inflation_x_mm"), -12.0, 2.0);
    EXPECT_LT((boards[0].corners[0] - truth * Eigen::Vector3d(0.1, 0.1, 0.0)).norm(), 0.004);
}

TEST(BoardLines, TheCovarianceIsThatOfTheErrors) {
    // Without asymmetry in the data and in the parameter, NEES of 6 degrees over 60 boards: mean 6,
    // standard error sqrt(12 / 60) = 0.45. The errors of a side are floored at 1 mm, so the
    // covariance may be too large by half, never too small by more than four standard errors.
    double sum = 0.0;
    const int runs = 60;
    for (int run = 0; run < runs; ++run) {
        Rng rng(static_cast<std::uint64_t>(100 + run));
        const Eigen::Isometry3d truth = board_pose(0.2, 0.2);
        const Cloud cloud = to_cloud(board_points(truth, 0.010, rng));
        auto planes = StageHarness::of<PlanesRansac>();
        planes.give<Cloud>("cloud", cloud).fire();
        auto stage = StageHarness::of<BoardLines>();
        stage.set("edge_asymmetry", Value(0.0));
        stage.give<Cloud>("cloud", cloud)
            .give<Planes>("planes", planes.out<Planes>("planes"))
            .fire();
        const auto& boards = stage.out<LidarBoards>("boards").boards;
        ASSERT_EQ(boards.size(), 1u);
        ASSERT_TRUE(boards[0].covariance);
        const Vector6d error = se3_log(boards[0].T_lidar_board * truth.inverse());
        sum += error.dot(boards[0].covariance->ldlt().solve(error));
    }
    EXPECT_LT(sum / runs, 6.0 + 4.0 * 0.45);
    EXPECT_GT(sum / runs, 2.0);
}

TEST(BoardLines, PointsOfThePlateTellItsPlane) {
    // The rim's points lie 3 mm behind along their rays; the plate's have 10 mm of noise there.
    Rng rng(8);
    const Eigen::Isometry3d truth = board_pose(0.2, 0.3);
    auto rim = board_points(truth, 0.010, rng);
    for (Eigen::Vector3d& p : rim) p += 0.003 * p.normalized();
    auto scene = rim;
    for (int i = 0; i < 20000; ++i) {
        const Eigen::Vector3d p =
            truth * Eigen::Vector3d(uniform(rng, 0.0, 0.5), uniform(rng, 0.0, 0.5), 0.0);
        scene.push_back(p + normal(rng, 0.010) * p.normalized());
    }
    auto planes = StageHarness::of<PlanesRansac>();
    planes.give<Cloud>("cloud", to_cloud(rim)).fire();
    const auto found = [&](const std::vector<Eigen::Vector3d>& cloud) {
        auto stage = StageHarness::of<BoardLines>();
        stage.give<Cloud>("cloud", to_cloud(cloud))
            .give<Planes>("planes", planes.out<Planes>("planes"))
            .fire();
        return stage.out<LidarBoards>("boards").boards.at(0);
    };
    const auto behind = [&](const LidarBoard& board) {
        const Eigen::Vector3d middle(0.25, 0.25, 0.0);
        return (truth.inverse() * (board.T_lidar_board * middle)).z();
    };
    const LidarBoard by_rim = found(rim), by_plate = found(scene);
    EXPECT_NEAR(behind(by_rim), 0.003, 0.0015);
    // 10 mm over some 8000 points: 0.1 mm. Five sigma.
    EXPECT_NEAR(behind(by_plate), 0.0, 0.0006);
    EXPECT_GT(by_plate.quality.at("plate_points"), 4000.0);
    EXPECT_EQ(by_rim.quality.at("plate_points"), 0.0);
    const auto sigma = [&](const LidarBoard& board) {
        const Eigen::Vector3d normal = truth.linear().col(2);
        const Eigen::Isometry3d middle =
            truth * Eigen::Translation3d(Eigen::Vector3d(0.25, 0.25, 0.0));
        const Matrix6d to_middle =
            adjoint(Eigen::Isometry3d(Eigen::Translation3d(middle.translation())).inverse());
        const Matrix6d own = to_middle * *board.covariance * to_middle.transpose();
        return std::sqrt(normal.dot(own.topLeftCorner<3, 3>() * normal));
    };
    EXPECT_GT(sigma(by_rim), 0.002) << "the rim's own error is in the covariance";
    EXPECT_LT(sigma(by_plate), 0.0005);
}

TEST(BoardLines, TooFewPointsOfThePlateTellNothing) {
    // Whose plane cannot be fitted must not be told as surer than the rim's.
    Rng rng(9);
    const HoleGrid grid = HoleGrid::of(load_target("four_square_holes_500mm"));
    const Eigen::Isometry3d truth = board_pose(0.2, 0.3);
    const auto rim = board_points(truth, 0.010, rng);
    const auto found = [&](const std::vector<Eigen::Vector3d>& plate) {
        Rng same(1);
        const auto attempt = BoardFinder(grid, {}).find(
            rim, truth, [&](const Eigen::Isometry3d&) { return plate; }, same, [] {});
        EXPECT_TRUE(attempt.board) << attempt.miss;
        return attempt.board.value_or(LidarBoard());
    };
    const LidarBoard without = found({}), with_three = found({truth.translation(), rim[0], rim[1]});
    ASSERT_TRUE(without.covariance && with_three.covariance);
    EXPECT_EQ(*with_three.covariance, *without.covariance);
    EXPECT_EQ(with_three.quality.at("plate_points"), 0.0);
}

TEST(BoardLines, PlainLinesGiveHolesThatAreTooLarge) {
    Rng rng(3);
    auto points = board_points(board_pose(0.1, 0.2), 0.010, rng);
    add_clutter(points, 50, rng);
    auto stage = detect(to_cloud(points), 2, false);
    const auto& boards = stage.out<LidarBoards>("boards").boards;
    ASSERT_EQ(boards.size(), 1u);
    // 100 mm and 10 mm on each side; a line's place is good to about 1 mm.
    EXPECT_NEAR(boards[0].quality.at("hole_side_x_mm"), 120.0, 3.0);
    EXPECT_NEAR(boards[0].quality.at("hole_side_y_mm"), 120.0, 3.0);
    EXPECT_FALSE(boards[0].covariance);
}

TEST(BoardLines, TwoBoardsInOnePlaneAreBothFound) {
    Rng rng(4);
    const Eigen::Isometry3d first = board_pose(0.0, 0.0);
    auto points = board_points(first, 0.010, rng);
    const auto second = board_points(first * Eigen::Translation3d(0.6, 0.05, 0.0), 0.010, rng);
    points.insert(points.end(), second.begin(), second.end());
    auto stage = detect(to_cloud(points), 1);
    EXPECT_EQ(stage.out<LidarBoards>("boards").boards.size(), 2u);
}

TEST(BoardLines, APlateWithoutHolesIsNoBoardAndTheNoteSaysWhatIsMissing) {
    Rng rng(5);
    auto stage = detect(to_cloud(board_points(board_pose(0.0, 0.0), 0.0, rng, false)), 1);
    EXPECT_TRUE(stage.out<LidarBoards>("boards").boards.empty());
    ASSERT_EQ(stage.notes().size(), 1u);
    EXPECT_THAT(stage.notes()[0].nearest_miss, HasSubstr("of 4"));
    EXPECT_THAT(stage.notes()[0].threshold, HasSubstr("4 + 4 lines"));
    bool picture = false;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(stage.folder()))
        picture = picture || entry.path().extension() == ".png";
    EXPECT_TRUE(picture) << "what was seen is saved where nothing was found";
}

TEST(BoardLines, PointsInsideTheHolesContradict) {
    Rng rng(6);
    const Eigen::Isometry3d truth = board_pose(0.0, 0.0);
    auto points = board_points(truth, 0.010, rng);
    for (int i = 0; i < 200; ++i)
        points.push_back(truth *
                         Eigen::Vector3d(uniform(rng, 0.1, 0.4), uniform(rng, 0.1, 0.4), 0.0));
    auto stage = detect(to_cloud(points), 1);
    EXPECT_TRUE(stage.out<LidarBoards>("boards").boards.empty());
    EXPECT_EQ(stage.notes().size(), 1u);
}

TEST(BoardLines, NoPlaneGivesNoBoardAndNoPlanesWireIsAnError) {
    auto stage = StageHarness::of<BoardLines>();
    stage.give<Cloud>("cloud", Cloud()).give<Planes>("planes", Planes()).fire();
    EXPECT_TRUE(stage.out<LidarBoards>("boards").boards.empty());
    ASSERT_EQ(stage.notes().size(), 1u);
    EXPECT_THAT(stage.notes()[0].nearest_miss, HasSubstr("no plane"));

    auto unwired = StageHarness::of<BoardLines>();
    unwired.give<Cloud>("cloud", Cloud());
    try {
        unwired.fire();
        FAIL() << "no error";
    } catch (const Error& error) {
        EXPECT_THAT(error.what(), HasSubstr("'planes'"));
    }
}

TEST(BoardLines, AnUnknownTargetIsAnError) {
    auto stage = StageHarness::of<BoardLines>();
    stage.set("target", "no_such_board");
    stage.give<Cloud>("cloud", Cloud()).give<Planes>("planes", Planes());
    EXPECT_THROW(stage.fire(), Error);
}

TEST(BoardLines, ATargetWithoutRectangularHolesIsRefused) {
    const std::pair<const char*, const char*> targets[] = {
        {"four_round_holes_aruco", "4 round holes, 4 markers"}, {"checkerboard", "1 checkerboard"}};
    for (const auto& [target, shows] : targets) {
        auto stage = StageHarness::of<BoardLines>();
        stage.set("target", target);
        stage.give<Cloud>("cloud", Cloud()).give<Planes>("planes", Planes());
        try {
            stage.fire();
            FAIL() << "no error";
        } catch (const Error& error) {
            EXPECT_THAT(error.what(), HasSubstr(target));
            EXPECT_THAT(error.what(), HasSubstr(shows));
            EXPECT_THAT(error.what(), HasSubstr("needs rectangular holes"));
        }
    }
}

TEST(BoardLines, NormalsAlongTheLidarsZHaveAnOrderToo) {
    // A board on the floor, seen from above: up is the LiDAR's +x.
    Rng rng(7);
    const Eigen::Isometry3d truth = plane_frame(Eigen::Vector3d::UnitZ(), {0.3, 0.2, -1.5}) *
                                    Eigen::Translation3d(-0.25, -0.25, 0.0);
    auto stage = detect(to_cloud(board_points(truth, 0.010, rng)), 1);
    const auto& boards = stage.out<LidarBoards>("boards").boards;
    ASSERT_EQ(boards.size(), 1u);
    EXPECT_LT(boards[0].T_lidar_board.linear()(0, 1), -0.9) << "y runs down, along -x";
}

}  // namespace
}  // namespace petal
