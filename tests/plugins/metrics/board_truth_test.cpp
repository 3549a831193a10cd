// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "metrics/board_truth.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <optional>

#include "petal/calibration/angles.hpp"
#include "petal/calibration/boards.hpp"
#include "petal/calibration/metrics.hpp"
#include "petal/calibration/se3.hpp"
#include "petal/calibration/truth.hpp"
#include "petal/testing/stage_harness.hpp"

namespace petal {
namespace {

using ::testing::HasSubstr;
using testing::StageHarness;

const Eigen::Vector3d kBoardMiddle(0.25, 0.25, 0.0);

std::vector<Eigen::Vector3d> hole_corners() {
    std::vector<Eigen::Vector3d> corners;
    for (const double y : {0.1, 0.2, 0.3, 0.4})
        for (const double x : {0.1, 0.2, 0.3, 0.4}) corners.emplace_back(x, y, 0.0);
    return corners;
}

/// Before the LiDAR (x ahead), turned by `turn` in its plane.
Eigen::Isometry3d placed(double range, double left, double turn = 0.0) {
    Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
    T.linear() << 0, 0, 1, -1, 0, 0, 0, -1, 0;
    T.linear() = Eigen::AngleAxisd(0.3, Eigen::Vector3d::UnitZ()).toRotationMatrix() * T.linear();
    T.translation() << range, left, 0.2;
    return T * Eigen::Translation3d(kBoardMiddle) *
           Eigen::AngleAxisd(turn, Eigen::Vector3d::UnitZ()) * Eigen::Translation3d(-kBoardMiddle);
}

/// A camera that needs no pose: 300 px for a metre of the board.
Eigen::Vector2d pixel_of(const Eigen::Vector3d& on_board, double left) {
    return {600.0 - 300.0 * left + 300.0 * on_board.x(), 200.0 + 290.0 * on_board.y()};
}

Truth::Board true_board(double range, double left) {
    Truth::Board board;
    board.target = "any";
    board.T_lidar_board = placed(range, left);
    for (const auto& corner : hole_corners()) {
        board.corners_lidar.push_back(board.T_lidar_board * corner);
        board.corners_image.push_back(pixel_of(corner, left));
    }
    return board;
}

/// A board at the pose, off by `error` along and about its own axes at its middle.
LidarBoard lidar_board(const Eigen::Isometry3d& pose, const Vector6d& error,
                       const Vector6d& sigmas) {
    LidarBoard board;
    const Eigen::Isometry3d middle = pose * Eigen::Translation3d(kBoardMiddle);
    board.T_lidar_board = middle * se3_exp(error) * Eigen::Translation3d(-kBoardMiddle);
    for (const auto& corner : hole_corners()) board.corners.push_back(board.T_lidar_board * corner);
    const Matrix6d to_lidar = adjoint(middle);
    board.covariance = to_lidar * Matrix6d(sigmas.cwiseAbs2().asDiagonal()) * to_lidar.transpose();
    return board;
}

ImageBoard image_board(const Truth::Board& truth, const Eigen::Vector2d& shift, double sigma,
                       const std::string& camera = "CAMERA") {
    ImageBoard board;
    board.camera = camera;
    for (const auto& corner : truth.corners_image) board.corners.push_back(corner + shift);
    board.joint_covariance = sigma * sigma * Eigen::MatrixXd::Identity(32, 32);
    return board;
}

StageHarness with(const std::vector<Truth::Board>& boards) {
    auto stage = StageHarness::of<BoardTruthMetric>("metric.board_truth");
    Truth truth;
    truth.boards = boards;
    stage.give<Truth>("truth", truth, "a");
    return stage;
}

LidarBoards lidar_boards(std::vector<LidarBoard> boards) {
    LidarBoards all;
    all.lidar = "LIDAR";
    all.boards = std::move(boards);
    return all;
}

ImageBoards image_boards(std::vector<ImageBoard> boards,
                         const std::vector<std::string>& cameras = {"CAMERA"}) {
    ImageBoards all;
    for (const std::string& camera : cameras) all.cameras.push_back({camera, {}});
    all.boards = std::move(boards);
    return all;
}

std::optional<double> board_told(const StageHarness& stage, const std::string& name,
                                 const std::string& scene = "") {
    for (const Metric& one : stage.out<Metrics>("metrics").values)
        if (one.name == "board_truth." + name && one.scene == scene) return one.value;
    return std::nullopt;
}

Vector6d six(double x, double y, double z, double turn_x, double turn_y, double turn_z) {
    Vector6d all;
    all << x, y, z, turn_x, turn_y, turn_z;
    return all;
}

const Vector6d kSigmas = six(0.001, 0.002, 0.0005, 0.002, 0.001, 0.004);

TEST(BoardTruthMetric, ErrorsOfTheLidarsPoseAreInTheBoardsOwnAxes) {
    // Small enough that second order is below 1e-7.
    const Vector6d error = six(1e-4, -4e-4, 1e-4, 4e-4, 0.0, -4e-4);
    auto stage = with({true_board(3.0, 0.4)});
    stage.set("range_offset_sigma", Value(0.0));
    stage.give<LidarBoards>("lidar", lidar_boards({lidar_board(placed(3.0, 0.4), error, kSigmas)}));
    stage.fire();
    EXPECT_NEAR(*board_told(stage, "board_1.lidar_x_m", "a"), 1e-4, 1e-6);
    EXPECT_NEAR(*board_told(stage, "board_1.lidar_y_m", "a"), -4e-4, 1e-6);
    EXPECT_NEAR(*board_told(stage, "board_1.lidar_z_m", "a"), 1e-4, 1e-6);
    EXPECT_NEAR(*board_told(stage, "board_1.lidar_turn_x_deg", "a"), 4e-4 * kDegrees, 1e-4);
    EXPECT_NEAR(*board_told(stage, "board_1.lidar_turn_z_deg", "a"), -4e-4 * kDegrees, 1e-4);
    EXPECT_NEAR(*board_told(stage, "board_1.lidar_x_sigmas", "a"), 0.1, 1e-3);
    EXPECT_NEAR(*board_told(stage, "board_1.lidar_y_sigmas", "a"), -0.2, 1e-3);
    EXPECT_NEAR(*board_told(stage, "board_1.lidar_turn_x_sigmas", "a"), 0.2, 1e-3);
    // 0.1^2 + 0.2^2 + 0.2^2 + 0.2^2 + 0 + 0.1^2
    EXPECT_NEAR(*board_told(stage, "board_1.lidar_nees", "a"), 0.14, 2e-3);
    EXPECT_NEAR(*board_told(stage, "lidar_nees_mean"), 0.14, 2e-3);
    EXPECT_NEAR(*board_told(stage, "lidar_y_rms_m"), 4e-4, 1e-6);
    EXPECT_NEAR(*board_told(stage, "lidar_y_rms_sigmas"), 0.2, 1e-3);
    EXPECT_DOUBLE_EQ(*board_told(stage, "lidar_found"), 1.0);
    EXPECT_FALSE(board_told(stage, "image_found"));
    EXPECT_TRUE(stage.notes().empty());
}

TEST(BoardTruthMetric, TheNearestOfTheBoardsFourOrdersCounts) {
    const Eigen::Vector2d shift(0.3, -0.4);
    for (int quarter = 0; quarter < 4; ++quarter) {
        const Truth::Board truth = true_board(3.0, 0.4);
        auto stage = with({truth});
        stage.give<LidarBoards>("lidar",
                                lidar_boards({lidar_board(placed(3.0, 0.4, quarter * kPi / 2.0),
                                                          Vector6d::Zero(), kSigmas)}));
        ImageBoard seen = image_board(truth, shift, 0.1);
        // Corner (row, column) of the turned board lies where (column, 3 - row) was.
        for (int turn = 0; turn < quarter; ++turn) {
            const auto before = seen.corners;
            for (std::size_t row = 0; row < 4; ++row)
                for (std::size_t column = 0; column < 4; ++column)
                    seen.corners[4 * row + column] = before[4 * column + 3 - row];
        }
        stage.give<ImageBoards>("image", image_boards({seen}));
        stage.fire();
        EXPECT_NEAR(*board_told(stage, "lidar_x_rms_m"), 0.0, 1e-9) << quarter;
        EXPECT_NEAR(*board_told(stage, "lidar_turn_z_rms_deg"), 0.0, 1e-6) << quarter;
        EXPECT_NEAR(*board_told(stage, "image_rms_px"), 0.5, 1e-9) << quarter;
        EXPECT_NEAR(*board_told(stage, "board_1.image_shift_u_px", "a"), 0.3, 1e-9) << quarter;
    }
}

TEST(BoardTruthMetric, TheImagesErrorsInSigmas) {
    const Truth::Board truth = true_board(3.0, 0.0);
    auto stage = with({truth});
    stage.give<ImageBoards>("image", image_boards({image_board(truth, {0.3, -0.4}, 0.1)}));
    stage.fire();
    EXPECT_NEAR(*board_told(stage, "board_1.image_nees", "a"), 16.0 * 0.25 / 0.01, 1e-6);
    EXPECT_NEAR(*board_told(stage, "board_1.image_nees_freedoms", "a"), 32.0, 1e-12);
    EXPECT_NEAR(*board_told(stage, "image_nees_per_freedom"), 12.5, 1e-9);
    // The mean of sixteen corners has a quarter of the sigma.
    EXPECT_NEAR(*board_told(stage, "board_1.image_shift_u_sigmas", "a"), 12.0, 1e-9);
    EXPECT_NEAR(*board_told(stage, "image_shift_v_rms_sigmas"), 16.0, 1e-9);
    EXPECT_FALSE(board_told(stage, "lidar_found"));
}

TEST(BoardTruthMetric, DirectionsThatTheCovarianceDoesNotKnowAreLeftOut) {
    const Truth::Board truth = true_board(3.0, 0.0);
    ImageBoard seen = image_board(truth, {0.3, -0.4}, 0.1);
    // Only a common shift: two directions, sigma 0.1 px each.
    Eigen::MatrixXd common(32, 2);
    for (Eigen::Index i = 0; i < 16; ++i)
        common.block<2, 2>(2 * i, 0) = 0.1 * Eigen::Matrix2d::Identity();
    seen.joint_covariance = common * common.transpose();
    auto stage = with({truth});
    stage.give<ImageBoards>("image", image_boards({seen}));
    stage.fire();
    EXPECT_NEAR(*board_told(stage, "board_1.image_nees_freedoms", "a"), 2.0, 1e-12);
    EXPECT_NEAR(*board_told(stage, "board_1.image_nees", "a"), 25.0, 1e-6);
}

TEST(BoardTruthMetric, TheRangeOffsetIsAddedAlongTheRay) {
    // Straight ahead and facing back: the ray is the board's normal but for 0.1 rad.
    auto nees = [](double offset) {
        auto stage = with({true_board(3.0, 0.0)});
        stage.set("range_offset_sigma", Value(offset));
        const Eigen::Isometry3d pose = placed(3.0, 0.0);
        LidarBoard board = lidar_board(pose, Vector6d::Zero(), kSigmas);
        const Eigen::Vector3d ray = (pose * kBoardMiddle).normalized();
        board.T_lidar_board = Eigen::Translation3d(0.005 * ray) * board.T_lidar_board;
        stage.give<LidarBoards>("lidar", lidar_boards({board}));
        stage.fire();
        return *board_told(stage, "lidar_nees_mean");
    };
    // One sigma of the offset alone is 1; the detector's own sigmas make it less.
    EXPECT_LT(nees(0.005), 1.0);
    EXPECT_GT(nees(0.005), 0.9);
    EXPECT_GT(nees(0.0), 50.0);
}

TEST(BoardTruthMetric, FoundMissedAndFalseBoards) {
    const std::vector<Truth::Board> truth = {true_board(3.0, 0.8), true_board(4.0, -0.8),
                                             true_board(3.0, 0.0)};
    auto stage = with(truth);
    // One found, one false: farther from every true board than its corners are.
    stage.give<LidarBoards>(
        "lidar", lidar_boards({lidar_board(placed(3.5, -0.8), Vector6d::Zero(), kSigmas),
                               lidar_board(placed(3.0, 0.0), Vector6d::Zero(), kSigmas)}));
    stage.give<ImageBoards>("image", image_boards({image_board(truth[1], {1.0, 0.0}, 0.1)}));
    stage.fire();
    for (const char* scene : {"", "a"}) {
        EXPECT_DOUBLE_EQ(*board_told(stage, "lidar_found", scene), 1.0);
        EXPECT_DOUBLE_EQ(*board_told(stage, "lidar_missed", scene), 2.0);
        EXPECT_DOUBLE_EQ(*board_told(stage, "lidar_false", scene), 1.0);
        EXPECT_DOUBLE_EQ(*board_told(stage, "image_found", scene), 1.0);
        EXPECT_DOUBLE_EQ(*board_told(stage, "image_missed", scene), 2.0);
        EXPECT_DOUBLE_EQ(*board_told(stage, "image_false", scene), 0.0);
    }
    EXPECT_TRUE(board_told(stage, "board_3.lidar_x_m", "a"));
    EXPECT_FALSE(board_told(stage, "board_1.lidar_x_m", "a"));
    EXPECT_TRUE(board_told(stage, "board_2.image_rms_px", "a"));
}

TEST(BoardTruthMetric, WithoutCovarianceThereAreErrorsButNoSigmas) {
    const Truth::Board truth = true_board(3.0, 0.0);
    auto stage = with({truth});
    LidarBoard board = lidar_board(placed(3.0, 0.0), Vector6d::Zero(), kSigmas);
    board.covariance.reset();
    ImageBoard seen = image_board(truth, {0.0, 0.0}, 0.1);
    seen.joint_covariance.resize(0, 0);
    stage.give<LidarBoards>("lidar", lidar_boards({board}));
    stage.give<ImageBoards>("image", image_boards({seen}));
    stage.fire();
    EXPECT_TRUE(board_told(stage, "board_1.lidar_x_m", "a"));
    EXPECT_TRUE(board_told(stage, "board_1.image_rms_px", "a"));
    for (const char* name : {"lidar_nees_mean", "image_nees_per_freedom", "lidar_x_rms_sigmas"})
        EXPECT_FALSE(board_told(stage, name)) << name;
}

TEST(BoardTruthMetric, RealScenesHaveNoFigures) {
    auto stage = with({});
    stage.give<LidarBoards>("lidar", lidar_boards({}));
    stage.fire();
    EXPECT_TRUE(stage.out<Metrics>("metrics").values.empty());
    ASSERT_EQ(stage.notes().size(), 1U);
    EXPECT_THAT(stage.notes()[0].nearest_miss, HasSubstr("no truth: 1 of 1 scenes"));
}

TEST(BoardTruthMetric, OfSeveralCamerasOneIsChosen) {
    const Truth::Board truth = true_board(3.0, 0.0);
    const auto fire = [&](const char* camera) {
        auto stage = with({truth});
        stage.set("camera", camera);
        stage.give<ImageBoards>("image",
                                image_boards({image_board(truth, {0.1, 0.0}, 0.1, "LEFT"),
                                              image_board(truth, {0.2, 0.0}, 0.1, "RIGHT")},
                                             {"LEFT", "RIGHT"}));
        stage.fire();
        return stage;
    };
    EXPECT_NEAR(*board_told(fire("RIGHT"), "image_rms_px"), 0.2, 1e-9);
    const auto open = fire("");
    EXPECT_TRUE(open.out<Metrics>("metrics").values.empty());
    ASSERT_EQ(open.notes().size(), 1U);
    EXPECT_THAT(open.notes()[0].nearest_miss, HasSubstr("'LEFT', 'RIGHT'"));
    const auto wrong = fire("MIDDLE");
    ASSERT_EQ(wrong.notes().size(), 1U);
    EXPECT_THAT(wrong.notes()[0].nearest_miss, HasSubstr("no camera 'MIDDLE'"));
}

TEST(BoardTruthMetric, NothingWiredIsTold) {
    auto stage = with({true_board(3.0, 0.0)});
    stage.fire();
    EXPECT_TRUE(stage.out<Metrics>("metrics").values.empty());
    ASSERT_EQ(stage.notes().size(), 1U);
    EXPECT_THAT(stage.notes()[0].nearest_miss, HasSubstr("neither"));
}

}  // namespace
}  // namespace petal
