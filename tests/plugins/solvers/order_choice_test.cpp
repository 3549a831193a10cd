// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "solvers/detail/order_choice.hpp"

#include <gmock/gmock.h>

#include <random>

#include "petal/calibration/camera_model.hpp"
#include "petal/calibration/se3.hpp"
#include "petal/testing/stage_harness.hpp"
#include "solvers/board_matcher.hpp"
#include "solvers/reprojection.hpp"

namespace petal {
namespace {

using ::testing::HasSubstr;
using testing::StageHarness;

mrpt::img::TCamera camera() {
    mrpt::img::TCamera k;
    k.ncols = 1280;
    k.nrows = 720;
    k.setIntrinsicParamsFromValues(900.0, 900.0, 640.0, 360.0);
    return k;
}

/// LiDAR x forward, y left, z up; 11 cm from the camera.
Eigen::Isometry3d T_camera_lidar() {
    Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
    T.linear() << 0, -1, 0, 0, 0, -1, 1, 0, 0;
    T.translation() << 0.05, -0.08, 0.05;
    return T;
}

/// A board of the letter in the camera's frame: its centre, turned about y (yaw) and x (pitch).
Eigen::Isometry3d board_at(double x, double y, double z, double yaw_deg, double pitch_deg) {
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    pose.linear() = (Eigen::AngleAxisd(yaw_deg * M_PI / 180.0, Eigen::Vector3d::UnitY()) *
                     Eigen::AngleAxisd(pitch_deg * M_PI / 180.0, Eigen::Vector3d::UnitX()))
                        .toRotationMatrix();
    pose.translation() =
        Eigen::Vector3d(x, y, z) - pose.linear() * Eigen::Vector3d(0.25, 0.25, 0.0);
    return pose;
}

/// Both sensors' boards of a scene; noise of the LiDAR's corners (m) and of the image's (px).
class Scene {
   public:
    Scene(double lidar_noise, double image_noise, unsigned seed)
        : lidar_noise_(lidar_noise), image_noise_(image_noise), random_(seed) {
        lidar.lidar = "LIDAR";
        image.cameras.push_back({"CAMERA", camera()});
    }

    void add(const Eigen::Isometry3d& board, bool in_lidar, bool in_image) {
        LidarBoard seen_by_lidar;
        ImageBoard seen_by_camera;
        seen_by_lidar.target = seen_by_camera.target = "four_square_holes_500mm";
        seen_by_camera.camera = "CAMERA";
        seen_by_lidar.T_lidar_board = T_camera_lidar().inverse() * board;
        const CameraModel model(camera());
        for (int row = 1; row <= 4; ++row)
            for (int column = 1; column <= 4; ++column) {
                const Eigen::Vector3d corner =
                    board * Eigen::Vector3d(0.1 * column, 0.1 * row, 0.0);
                seen_by_lidar.corners.push_back(T_camera_lidar().inverse() * corner +
                                                noise<3>(lidar_noise_));
                seen_by_camera.corners.push_back(model.project(corner).value() +
                                                 noise<2>(image_noise_));
                seen_by_camera.covariance.push_back(0.04 * Eigen::Matrix2d::Identity());
            }
        if (in_lidar) lidar.boards.push_back(seen_by_lidar);
        if (in_image) image.boards.push_back(seen_by_camera);
    }

    StageHarness stage() const {
        auto harness = StageHarness::of<BoardMatcher>("solver.board_matcher");
        harness.give<LidarBoards>("lidar", lidar).give<ImageBoards>("image", image);
        return harness;
    }
    OrderDecision decision() const {
        auto harness = stage();
        harness.fire();
        return harness.out<Correspondences>("correspondences").cameras.at(0).order;
    }

    LidarBoards lidar;
    ImageBoards image;

   private:
    template <int N>
    Eigen::Matrix<double, N, 1> noise(double sigma) {
        Eigen::Matrix<double, N, 1> vector;
        for (int i = 0; i < N; ++i)
            vector(i) = std::normal_distribution<double>(0, 1)(random_) * sigma;
        return vector;
    }
    double lidar_noise_;
    double image_noise_;
    std::mt19937 random_;
};

TEST(OrderChoice, ThreeBoardsAreDecidedByTheDataAndTellARunnerUp) {
    Scene scene(0.002, 0.2, 1);
    scene.add(board_at(-0.8, 0.3, 2.5, 20, 5), true, true);
    scene.add(board_at(0.1, -0.3, 3.2, -15, -20), true, true);
    scene.add(board_at(0.9, 0.2, 2.8, -25, 10), true, true);
    const OrderDecision decision = scene.decision();
    EXPECT_EQ(decision.by, DecidedBy::data);
    EXPECT_GE(decision.runner_up_rms_ratio, 1.5)
        << "the nearest kin are tried where the search finds none";
    EXPECT_FALSE(decision.contradicts_priors);
}

// With 10 mm of noise the corners no longer show that the board is symmetric; it still is.
TEST(OrderChoice, OneBoardNeverDecidesByData) {
    for (unsigned seed = 1; seed <= 20; ++seed) {
        Scene scene(0.010, 0.3, seed);
        scene.add(board_at(0.2, 0.1, 3.0, 25, 15), true, true);
        EXPECT_NE(scene.decision().by, DecidedBy::data) << "seed " << seed;
    }
}

TEST(OrderChoice, AnOrderThatLeavesMoreThanNoiseIsNotTheDatas) {
    // The camera's second board is another one, 30 cm off and turned: the best order of two boards
    // fits it badly, though better than every other one.
    int by_data = 0;
    for (unsigned seed = 1; seed <= 20; ++seed) {
        Scene scene(0.002, 0.3, seed);
        scene.add(board_at(-0.7, 0.2, 2.5, 15, 5), true, true);
        scene.add(board_at(0.7, -0.1, 3.0, -20, 10), true, false);
        scene.add(board_at(0.75, 0.2, 3.4, 10, -15), false, true);
        by_data += scene.decision().by == DecidedBy::data ? 1 : 0;
    }
    EXPECT_EQ(by_data, 0);
}

TEST(OrderChoice, OrdersOfTheDataAgainstAPriorAreTold) {
    // The LiDAR is mounted upside down: data decide, and the prior `upright` does not hold.
    Scene scene(0.002, 0.2, 1);
    scene.add(board_at(-0.8, 0.3, 2.5, 20, 5), true, true);
    scene.add(board_at(0.1, -0.3, 3.2, -15, -20), true, true);
    scene.add(board_at(0.9, 0.2, 2.8, -25, 10), true, true);
    const Eigen::Matrix3d over =
        Eigen::AngleAxisd(M_PI, Eigen::Vector3d::UnitX()).toRotationMatrix();
    for (LidarBoard& board : scene.lidar.boards) {
        for (Eigen::Vector3d& corner : board.corners) corner = over * corner;
        board.T_lidar_board.prerotate(over);
    }
    const OrderDecision decision = scene.decision();
    EXPECT_EQ(decision.by, DecidedBy::data);
    EXPECT_TRUE(decision.contradicts_priors);
    auto solver = StageHarness::of<Reprojection>("solver.reprojection");
    auto matcher = scene.stage();
    matcher.fire();
    solver.give<Correspondences>("correspondences",
                                 matcher.out<Correspondences>("correspondences"));
    solver.fire();
    EXPECT_EQ(solver.verdict(), Level::weak);
    EXPECT_THAT(solver.reasons().back(), HasSubstr("do not hold"));
}

TEST(OrderChoice, TheSolverKeepsThePoseThatAPriorChose) {
    // One board, nearly frontal and far: both planar minima fit alike, the residuals choose by
    // noise.
    int apart = 0;
    for (unsigned seed = 1; seed <= 20; ++seed) {
        Scene scene(0.004, 0.3, seed);
        scene.add(board_at(0.3, 0.1, 5.0, 12, 6), true, true);
        auto matcher = scene.stage();
        matcher.fire();
        const auto& found = matcher.out<Correspondences>("correspondences");
        if (found.cameras[0].order.by != DecidedBy::prior) continue;
        auto solver = StageHarness::of<Reprojection>("solver.reprojection");
        solver.give<Correspondences>("correspondences", found);
        solver.fire();
        const auto& solved = solver.out<Extrinsics>("extrinsics").cameras.at(0);
        const Eigen::Matrix3d between =
            solved.T_camera_lidar.linear().transpose() * found.cameras[0].initial.front().linear();
        // Weights differ between matcher and solver, so not the same pose; but not another minimum.
        apart += rotation_angle(between) > 10.0 * M_PI / 180.0 ? 1 : 0;
    }
    EXPECT_EQ(apart, 0);
}

TEST(OrderChoice, TooManyImageBoardsAreCutWithANote) {
    Scene scene(0.002, 0.2, 1);
    scene.add(board_at(-0.8, 0.3, 2.5, 20, 5), true, true);
    scene.add(board_at(0.1, -0.3, 3.2, -15, -20), true, true);
    scene.add(board_at(0.9, 0.2, 4.8, -25, 10), false, true);
    auto stage = scene.stage();
    stage.set("max_image_boards", 2).fire();
    EXPECT_THAT(stage.notes().at(0).nearest_miss, HasSubstr("only the 2 largest"));
    const auto& found = stage.out<Correspondences>("correspondences").cameras.at(0);
    for (const auto& board : found.boards) EXPECT_LT(board.image, 2);
}

TEST(OrderChoice, CancelEndsTheSearch) {
    Scene scene(0.002, 0.2, 1);
    for (int i = 0; i < 4; ++i)
        scene.add(board_at(-1.2 + 0.8 * i, 0.1, 3.0, 10.0 * i, 5), true, true);
    auto stage = scene.stage();
    stage.cancel();
    EXPECT_THROW(stage.fire(), Cancelled);
}

}  // namespace
}  // namespace petal
