// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "solvers/board_matcher.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdio>
#include <limits>

#include "petal/calibration/angles.hpp"
#include "petal/calibration/extrinsics.hpp"
#include "petal/calibration/se3.hpp"
#include "petal/error.hpp"
#include "petal/testing/stage_harness.hpp"
#include "plugins/solvers/real_pairs.hpp"
#include "real_data.hpp"
#include "solvers/reprojection.hpp"

namespace petal {
namespace {

using ::testing::HasSubstr;
using testing::StageHarness;

/// A quarter turn of the four by four grid, k times.
std::size_t turned(std::size_t i, int k) {
    std::size_t row = i / 4, column = i % 4;
    for (int n = 0; n < k; ++n) {
        const std::size_t old = row;
        row = column;
        column = 3 - old;
    }
    return row * 4 + column;
}

/// A LiDAR board from corners row by row; its order turned k times, as a detector without gravity
/// has it.
LidarBoard lidar_board(const std::vector<PointPair>& corners, int k) {
    LidarBoard board;
    board.target = "four_square_holes_500mm";
    for (std::size_t i = 0; i < 16; ++i) board.corners.push_back(corners[turned(i, k)].lidar);
    const Eigen::Vector3d x = (board.corners[3] - board.corners[0]).normalized();
    const Eigen::Vector3d z = x.cross(board.corners[12] - board.corners[0]).normalized();
    board.T_lidar_board.linear() << x, z.cross(x), z;
    board.T_lidar_board.translation() = board.corners[0];
    return board;
}

ImageBoard image_board(const std::vector<PointPair>& corners) {
    ImageBoard board;
    board.target = "four_square_holes_500mm";
    board.camera = "CAMERA";
    for (const PointPair& pair : corners) board.corners.push_back(pair.image);
    return board;
}

struct SceneBoards {
    LidarBoards lidar;
    ImageBoards image;
};

/// The given boards of `pairs` (LiDAR, then image: indices into all boards), each list in its
/// order.
SceneBoards scene_of(const std::vector<PointPair>& pairs, const mrpt::img::TCamera& camera,
                     const std::vector<int>& lidar, const std::vector<int>& image, int turn = 1) {
    SceneBoards scene;
    scene.lidar.lidar = "LIDAR";
    scene.image.cameras.push_back({"CAMERA", camera});
    int k = turn;
    for (const int board : lidar)
        scene.lidar.boards.push_back(lidar_board(testing::board_in_rows(pairs, board), k++ % 4));
    for (const int board : image)
        scene.image.boards.push_back(image_board(testing::board_in_rows(pairs, board)));
    return scene;
}

StageHarness matched(const SceneBoards& scene) {
    auto stage = StageHarness::of<BoardMatcher>("solver.board_matcher");
    stage.give<LidarBoards>("lidar", scene.lidar).give<ImageBoards>("image", scene.image);
    stage.fire();
    return stage;
}

const CameraPairs& matched(const StageHarness& stage) {
    return stage.out<Correspondences>("correspondences").cameras.at(0);
}

/// Pairs that are not among the published ones.
int wrong_pairs(const CameraPairs& found, const std::vector<PointPair>& published) {
    int wrong = 0;
    for (const PointPair& pair : found.pairs) {
        bool known = false;
        for (const PointPair& right : published)
            known = known || (right.lidar == pair.lidar && right.image == pair.image);
        wrong += known ? 0 : 1;
    }
    return wrong;
}

void tell(const std::string& what, const CameraPairs& found) {
    std::printf("%-22s %zu boards  RMS %.2f px  runner-up x %.2f, chi2 %+.1f  by %s: %s\n",
                what.c_str(), found.boards.size(), found.order.rms_px,
                found.order.runner_up_rms_ratio, found.order.runner_up_chi2,
                to_string(found.order.by), found.order.reason.c_str());
}

std::string names(const std::vector<int>& boards) {
    std::string text;
    for (const int board : boards) text += std::to_string(board + 1);
    return text;
}

TEST(BoardMatcher, IndoorSubsetsAreAllRightWithThePriorsOn) {
    PETAL_NEEDS_REAL_DATA();
    const auto pairs = testing::indoor_pairs(testing::real_data());
    const std::vector<std::vector<int>> subsets{
        {0},    {1},    {2},       {3},       {0, 1},    {2, 0},    {0, 3},      {2, 1},
        {1, 3}, {3, 2}, {2, 0, 1}, {3, 0, 1}, {0, 2, 3}, {3, 2, 1}, {2, 0, 3, 1}};
    for (const auto& lidar : subsets) {
        for (const bool all_images : {false, true}) {
            const auto image = all_images ? std::vector<int>{3, 1, 0, 2} : lidar;
            const auto stage = matched(scene_of(pairs, testing::indoor_camera(), lidar, image));
            const auto& found = matched(stage);
            tell("lidar " + names(lidar) + " image " + names(image), found);
            EXPECT_EQ(found.boards.size(), lidar.size());
            // One LiDAR board fits any of four image boards: two of the four stay undecided.
            if (lidar.size() == 1 && all_images && found.order.by == DecidedBy::undecided) continue;
            EXPECT_EQ(wrong_pairs(found, pairs), 0);
            EXPECT_NE(found.order.by, DecidedBy::undecided);
            if (lidar.size() == 1) {
                EXPECT_EQ(found.order.by, DecidedBy::prior);
            }
            if (lidar.size() >= 3) {
                EXPECT_EQ(found.order.by, DecidedBy::data);
            }
        }
    }
}

TEST(BoardMatcher, WithoutPriorsASingleBoardIsUndecided) {
    PETAL_NEEDS_REAL_DATA();
    const auto pairs = testing::indoor_pairs(testing::real_data());
    const auto scene = scene_of(pairs, testing::indoor_camera(), {0}, {0});
    auto stage = StageHarness::of<BoardMatcher>();
    stage.set("upright", false).set("use_max_baseline", false);
    stage.give<LidarBoards>("lidar", scene.lidar).give<ImageBoards>("image", scene.image);
    stage.fire();
    EXPECT_EQ(matched(stage).order.by, DecidedBy::undecided);
    EXPECT_THAT(matched(stage).order.reason, HasSubstr("no prior is on"));
    EXPECT_EQ(matched(stage).pairs.size(), 16u);
}

TEST(BoardMatcher, CampusBoardsAreDecidedByThePriorAndWeak) {
    PETAL_NEEDS_REAL_DATA();
    const auto pairs = testing::campus_pairs(testing::real_data());
    const auto stage = matched(scene_of(pairs, testing::campus_camera(), {1, 0}, {0, 1}));
    const auto& found = matched(stage);
    tell("campus", found);

    EXPECT_EQ(wrong_pairs(found, pairs), 0);
    EXPECT_EQ(found.pairs.size(), 32u);
    EXPECT_EQ(found.order.by, DecidedBy::prior);
    EXPECT_GT(found.order.runner_up_rms_ratio, 1.0);  // measured: 1.2
    EXPECT_LT(found.order.runner_up_rms_ratio, 1.5);

    auto solver = StageHarness::of<Reprojection>();
    solver.give<Correspondences>("correspondences", stage.out<Correspondences>("correspondences"));
    solver.fire();
    EXPECT_EQ(solver.verdict(), Level::weak);
    EXPECT_THAT(solver.reasons(), ::testing::Contains(HasSubstr("decided by the prior")));
    EXPECT_THAT(solver.out<Extrinsics>("extrinsics").cameras.at(0).weakest_direction,
                HasSubstr("tilting about the camera's x axis"));
    for (const auto& reason : solver.reasons()) std::printf("  %s\n", reason.c_str());
}

TEST(BoardMatcher, ThreeBoardsThenTheSolverComeNearThePublishedPose) {
    PETAL_NEEDS_REAL_DATA();
    const auto pairs = testing::indoor_pairs(testing::real_data());
    const auto stage = matched(scene_of(pairs, testing::indoor_camera(), {3, 1, 2}, {0, 1, 2, 3}));
    auto solver = StageHarness::of<Reprojection>();
    solver.give<Correspondences>("correspondences", stage.out<Correspondences>("correspondences"));
    solver.fire();
    const auto published =
        testing::published_pose(testing::real_data() / "sjtu_indoor/published_extrinsic.txt");
    const auto& camera = solver.out<Extrinsics>("extrinsics").cameras.at(0);
    // Measured with plain least squares: 0.6 deg and 3 cm.
    EXPECT_LT(
        kDegrees * rotation_angle(camera.T_camera_lidar.linear() * published.linear().transpose()),
        1.0);
    EXPECT_LT((camera.T_camera_lidar.translation() - published.translation()).norm(), 0.05);
    EXPECT_EQ(solver.verdict(), Level::weak);
    for (const auto& reason : solver.reasons()) std::printf("  %s\n", reason.c_str());
}

/// Noise-free boards in front of a camera that looks along the LiDAR's x.
SceneBoards made_scene(const std::vector<Eigen::Vector3d>& places, const Eigen::Isometry3d& T) {
    const CameraModel model(testing::indoor_camera());
    std::vector<PointPair> pairs;
    for (std::size_t b = 0; b < places.size(); ++b) {
        const double tilt = 0.2 * static_cast<double>(b) - 0.2;
        const Eigen::AngleAxisd turn(tilt, Eigen::Vector3d(0.0, 0.3, 1.0).normalized());
        for (int i = 0; i < 16; ++i) {
            PointPair pair;
            pair.lidar =
                places[b] + turn * Eigen::Vector3d(0.0, 0.15 - 0.1 * (i % 4), 0.15 - 0.1 * (i / 4));
            pair.image = model.project(T * pair.lidar).value();
            pair.board = static_cast<int>(b);
            pair.corner = i;
            pairs.push_back(pair);
        }
    }
    SceneBoards scene;
    scene.lidar.lidar = "LIDAR";
    scene.image.cameras.push_back({"CAMERA", testing::indoor_camera()});
    for (std::size_t b = 0; b < places.size(); ++b) {
        const std::vector<PointPair> corners(pairs.begin() + static_cast<long>(16 * b),
                                             pairs.begin() + static_cast<long>(16 * b + 16));
        scene.lidar.boards.push_back(lidar_board(corners, static_cast<int>(b)));
        scene.image.boards.push_back(image_board(corners));
    }
    return scene;
}

Eigen::Isometry3d looking_along_x() {
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    pose.linear() << 0, -1, 0, 0, 0, -1, 1, 0, 0;
    pose.translation() = Eigen::Vector3d(0.1, -0.05, 0.02);
    return pose;
}

TEST(BoardMatcher, ThreeBoardsOfASimulatedSceneAreDecidedByTheData) {
    const auto scene =
        made_scene({{2.5, 0.8, 0.1}, {3.5, -0.6, 0.3}, {2.8, 0.1, -0.5}}, looking_along_x());
    const auto stage = matched(scene);
    EXPECT_EQ(matched(stage).order.by, DecidedBy::data);
    EXPECT_EQ(matched(stage).boards.size(), 3u);
    ASSERT_FALSE(matched(stage).initial.empty());
    // Noise-free: the solver's convergence is what is left.
    EXPECT_LT(
        rotation_angle(matched(stage).initial[0].linear() * looking_along_x().linear().transpose()),
        1e-6);
    // The image's 1 px^2 and the LiDAR's noise.
    EXPECT_GT(matched(stage).pairs[0].covariance(0, 0), 1.0);
    EXPECT_TRUE(stage.notes().empty());
}

TEST(BoardMatcher, ExactDataOfOneBoardDecideNothing) {
    const auto stage = matched(made_scene({{2.5, 0.3, 0.1}}, looking_along_x()));
    EXPECT_EQ(matched(stage).order.by, DecidedBy::prior);
    ASSERT_FALSE(matched(stage).initial.empty());
    EXPECT_LT(matched(stage).initial[0].translation().norm(), 1.0);
}

TEST(BoardMatcher, ABoardThatOnlyOneSensorSeesIsLeftOut) {
    auto scene = made_scene({{2.5, 0.8, 0.1}, {3.5, -0.6, 0.3}, {2.8, 0.1, -0.5}, {4.0, 0.9, 0.8}},
                            looking_along_x());
    scene.lidar.boards.erase(scene.lidar.boards.begin());
    scene.image.boards.pop_back();
    const auto stage = matched(scene);
    ASSERT_EQ(matched(stage).boards.size(), 2u);
    for (const auto& board : matched(stage).boards) EXPECT_EQ(board.lidar + 1, board.image);
    EXPECT_EQ(stage.notes().size(), 1u);  // two of three and three
}

TEST(BoardMatcher, NothingToMatchIsTold) {
    auto scene = made_scene({{2.5, 0.3, 0.1}}, looking_along_x());
    const auto full = scene;
    scene.lidar.boards.clear();
    auto stage = matched(scene);
    EXPECT_TRUE(matched(stage).pairs.empty());
    EXPECT_EQ(matched(stage).camera, "CAMERA");
    ASSERT_EQ(stage.notes().size(), 1u);

    scene = full;
    scene.image.boards.clear();
    EXPECT_EQ(matched(scene).notes().size(), 1u);

    scene = full;
    scene.image.boards[0].target = "another";
    EXPECT_EQ(matched(scene).notes().size(), 1u);

    // Corners that no board explains: the nearest miss is told.
    scene = full;
    for (std::size_t i = 0; i < 16; ++i)
        scene.image.boards[0].corners[i] += 40.0 * Eigen::Vector2d(i % 3 == 0, i % 2 == 0);
    stage = matched(scene);
    EXPECT_TRUE(matched(stage).pairs.empty());
    EXPECT_THAT(stage.notes().at(0).nearest_miss, HasSubstr("gate"));
}

TEST(BoardMatcher, InvalidBoardsAreRefused) {
    const auto good = made_scene({{2.5, 0.3, 0.1}}, looking_along_x());
    auto scene = good;
    scene.lidar.boards[0].corners[3].x() = std::numeric_limits<double>::quiet_NaN();
    EXPECT_THROW(matched(scene), Error);
    scene = good;
    scene.image.boards[0].corners[3].x() = std::numeric_limits<double>::quiet_NaN();
    EXPECT_THROW(matched(scene), Error);
    scene = good;
    scene.image.boards[0].camera = "nobody";
    EXPECT_THROW(matched(scene), Error);
    scene = good;
    scene.image.boards[0].corners.resize(3);
    EXPECT_THROW(matched(scene), Error);
}

}  // namespace
}  // namespace petal
