// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "metrics/truth.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <optional>

#include "petal/calibration/angles.hpp"
#include "petal/calibration/extrinsics.hpp"
#include "petal/calibration/metrics.hpp"
#include "petal/calibration/truth.hpp"
#include "petal/testing/stage_harness.hpp"

namespace petal {
namespace {

using ::testing::HasSubstr;
using testing::StageHarness;

constexpr double kFocal = 900.0, kCentreU = 640.0, kCentreV = 360.0, kK1 = -0.1;
constexpr double kNotANumber = std::numeric_limits<double>::quiet_NaN();

/// The usual mounting (LiDAR's x is the camera's z), a little off.
Eigen::Isometry3d true_pose() {
    Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
    T.linear() << 0, -1, 0, 0, 0, -1, 1, 0, 0;
    T.linear() =
        Eigen::AngleAxisd(0.05, Eigen::Vector3d(1, 2, -1).normalized()).toRotationMatrix() *
        T.linear();
    T.translation() << 0.04, -0.1, 0.02;
    return T;
}

/// Off by 0.3 deg about an axis of the camera and 5 mm along a direction of it.
const Eigen::Vector3d kAxis = Eigen::Vector3d(2.0, -1.0, 2.0) / 3.0;
const Eigen::Vector3d kShift = Eigen::Vector3d(0.003, 0.0, -0.004);

Eigen::Isometry3d pose_off(const Eigen::Isometry3d& truth) {
    Eigen::Isometry3d T = truth;
    T.linear() = Eigen::AngleAxisd(0.3 / kDegrees, kAxis).toRotationMatrix() * truth.linear();
    T.translation() += kShift;
    return T;
}

CameraExtrinsics solved(const Eigen::Isometry3d& pose, const std::string& camera = "CAMERA") {
    CameraExtrinsics one;
    one.camera = camera;
    one.lidar = "LIDAR";
    one.model.ncols = 1280;
    one.model.nrows = 720;
    one.model.setIntrinsicParamsFromValues(kFocal, kFocal, kCentreU, kCentreV);
    one.model.distortion = mrpt::img::DistortionModel::plumb_bob;
    one.model.dist.fill(0.0);
    one.model.k1(kK1);
    one.T_camera_lidar = pose;
    one.covariance = 1e-6 * Matrix6d::Identity();
    return one;
}

/// A flat board some metres ahead; its four corners stand for those of its holes.
Truth::Board board_at(double range, double left) {
    Truth::Board board;
    board.target = "any";
    for (const double up : {0.0, 0.3})
        for (const double side : {0.0, 0.3})
            board.corners_lidar.emplace_back(range, left + side, up);
    return board;
}

Truth truth_of(const Eigen::Isometry3d& pose, std::vector<Truth::Board> boards) {
    Truth truth;
    truth.T_camera_lidar = pose;
    truth.boards = std::move(boards);
    return truth;
}

StageHarness metric(std::vector<CameraExtrinsics> cameras) {
    auto stage = StageHarness::of<TruthMetric>("metric.truth");
    Extrinsics extrinsics;
    extrinsics.cameras = std::move(cameras);
    stage.give<Extrinsics>("extrinsics", extrinsics);
    return stage;
}

std::optional<double> told(const StageHarness& stage, const std::string& name,
                           const std::string& scene = "") {
    for (const Metric& one : stage.out<Metrics>("metrics").values)
        if (one.name == "truth." + name && one.scene == scene) return one.value;
    return std::nullopt;
}

std::size_t figures(const StageHarness& stage) {
    return stage.out<Metrics>("metrics").values.size();
}

/// The pixel by the formula of the plumb bob model, apart from CameraModel.
Eigen::Vector2d pixel_by_hand(const Eigen::Isometry3d& T, const Eigen::Vector3d& lidar) {
    const Eigen::Vector3d p = T.linear() * lidar + T.translation();
    const double x = p.x() / p.z(), y = p.y() / p.z();
    const double bent = 1.0 + kK1 * (x * x + y * y);
    return {kFocal * x * bent + kCentreU, kFocal * y * bent + kCentreV};
}

TEST(TruthMetric, KnownErrorsOfThePose) {
    auto stage = metric({solved(pose_off(true_pose()))});
    stage.give<Truth>("truth", truth_of(true_pose(), {board_at(3.0, 0.2)}), "a");
    stage.fire();
    for (const char* scene : {"", "a"}) {
        EXPECT_NEAR(*told(stage, "rotation_deg", scene), 0.3, 1e-9);
        EXPECT_NEAR(*told(stage, "rotation_x_deg", scene), 0.2, 1e-9);
        EXPECT_NEAR(*told(stage, "rotation_y_deg", scene), -0.1, 1e-9);
        EXPECT_NEAR(*told(stage, "rotation_z_deg", scene), 0.2, 1e-9);
        EXPECT_NEAR(*told(stage, "translation_m", scene), 0.005, 1e-12);
        EXPECT_NEAR(*told(stage, "translation_x_m", scene), 0.003, 1e-12);
        EXPECT_NEAR(*told(stage, "translation_y_m", scene), 0.0, 1e-12);
        EXPECT_NEAR(*told(stage, "translation_z_m", scene), -0.004, 1e-12);
    }
    EXPECT_TRUE(stage.notes().empty());
}

TEST(TruthMetric, DriftIsThatOfTheCornersOfAllScenes) {
    const Eigen::Isometry3d off = pose_off(true_pose());
    auto stage = metric({solved(off)});
    const std::vector<std::vector<Truth::Board>> scenes = {
        {board_at(3.0, 0.2)}, {board_at(5.0, -0.7), board_at(4.0, 0.5)}};
    std::vector<double> means;
    double sum = 0.0, largest = 0.0, count = 0.0;
    for (const auto& boards : scenes) {
        double scene_sum = 0.0, scene_count = 0.0;
        for (const Truth::Board& board : boards)
            for (const Eigen::Vector3d& corner : board.corners_lidar) {
                const double drift =
                    (pixel_by_hand(off, corner) - pixel_by_hand(true_pose(), corner)).norm();
                scene_sum += drift;
                scene_count += 1.0;
                largest = std::max(largest, drift);
            }
        sum += scene_sum;
        count += scene_count;
        means.push_back(scene_sum / scene_count);
        stage.give<Truth>("truth", truth_of(true_pose(), boards));
    }
    stage.fire();
    // About 0.3 deg times 900 px a rad: else the case would prove nothing.
    ASSERT_GT(sum / count, 2.0);
    EXPECT_NEAR(*told(stage, "drift_px"), sum / count, 1e-9);
    EXPECT_NEAR(*told(stage, "drift_max_px"), largest, 1e-9);
    EXPECT_DOUBLE_EQ(*told(stage, "drift_count"), 12.0);
    EXPECT_NEAR(*told(stage, "drift_px", "0"), means[0], 1e-9);  // told by their numbers
    EXPECT_NEAR(*told(stage, "drift_px", "1"), means[1], 1e-9);
}

TEST(TruthMetric, TheTruthItselfHasNoError) {
    auto stage = metric({solved(true_pose())});
    stage.give<Truth>("truth", truth_of(true_pose(), {board_at(3.0, 0.2)}));
    stage.fire();
    EXPECT_NEAR(*told(stage, "rotation_deg"), 0.0, 1e-12);
    EXPECT_NEAR(*told(stage, "translation_m"), 0.0, 1e-15);
    EXPECT_NEAR(*told(stage, "drift_px"), 0.0, 1e-12);
    EXPECT_NEAR(*told(stage, "nees"), 0.0, 1e-12);
}

TEST(TruthMetric, CornersThatDoNotProjectAreLeftOutAndTold) {
    auto stage = metric({solved(pose_off(true_pose()))});
    Truth::Board odd = board_at(-3.0, 0.2);  // behind
    odd.corners_lidar.emplace_back(3.0, 0.0, 0.0);
    odd.corners_lidar.emplace_back(3.0, kNotANumber, 0.0);
    stage.give<Truth>("truth", truth_of(true_pose(), {odd}));
    stage.fire();
    EXPECT_DOUBLE_EQ(*told(stage, "drift_count"), 1.0);
    EXPECT_TRUE(std::isfinite(*told(stage, "drift_px")));
    ASSERT_EQ(stage.notes().size(), 1U);
    EXPECT_THAT(stage.notes()[0].nearest_miss, HasSubstr("5 of 6 true corners do not project"));

    auto none = metric({solved(pose_off(true_pose()))});
    none.give<Truth>("truth", truth_of(true_pose(), {}));
    none.fire();
    EXPECT_DOUBLE_EQ(*told(none, "drift_count"), 0.0);
    EXPECT_FALSE(told(none, "drift_px"));
    EXPECT_NEAR(*told(none, "rotation_deg"), 0.3, 1e-9);
    EXPECT_TRUE(none.notes().empty());
}

TEST(TruthMetric, WithoutACovarianceThereIsNoNees) {
    auto one = solved(pose_off(true_pose()));
    one.covariance.setZero();
    auto stage = metric({one});
    stage.give<Truth>("truth", truth_of(true_pose(), {}));
    stage.fire();
    EXPECT_FALSE(told(stage, "nees"));
    EXPECT_NEAR(*told(stage, "rotation_deg"), 0.3, 1e-9);
    ASSERT_EQ(stage.notes().size(), 1U);
    EXPECT_THAT(stage.notes()[0].nearest_miss, HasSubstr("not positive definite"));
}

TEST(TruthMetric, RealScenesHaveNoFigures) {
    auto stage = metric({solved(true_pose()), solved(true_pose(), "OTHER")});
    stage.give<Truth>("truth", Truth{}, "a").give<Truth>("truth", Truth{}, "b");
    stage.fire();
    EXPECT_EQ(figures(stage), 0U);
    ASSERT_EQ(stage.notes().size(), 1U);
    EXPECT_THAT(stage.notes()[0].nearest_miss, HasSubstr("no truth: none of 2 scenes"));
    EXPECT_THAT(stage.notes()[0].hint, HasSubstr("source.simulator"));
}

TEST(TruthMetric, ScenesWithoutTruthDoNotCountBesideOthers) {
    auto stage = metric({solved(pose_off(true_pose()))});
    stage.give<Truth>("truth", Truth{}, "real");
    stage.give<Truth>("truth", truth_of(true_pose(), {board_at(3.0, 0.0)}), "simulated");
    stage.fire();
    EXPECT_NEAR(*told(stage, "rotation_deg"), 0.3, 1e-9);
    EXPECT_TRUE(told(stage, "drift_px", "simulated"));
    EXPECT_FALSE(told(stage, "rotation_deg", "real"));
    ASSERT_EQ(stage.notes().size(), 1U);
    EXPECT_THAT(stage.notes()[0].nearest_miss, HasSubstr("1 of 2 scenes"));
    EXPECT_THAT(stage.notes()[0].nearest_miss, HasSubstr("'real'"));
}

TEST(TruthMetric, RigsThatDifferAreToldNotAveraged) {
    auto stage = metric({solved(true_pose())});
    Eigen::Isometry3d other = true_pose();
    other.translation().z() -= 0.2;
    stage.give<Truth>("truth", truth_of(true_pose(), {board_at(3.0, 0.0)}), "a");
    stage.give<Truth>("truth", truth_of(other, {board_at(3.0, 0.0)}), "b");
    stage.fire();
    EXPECT_NEAR(*told(stage, "translation_m", "a"), 0.0, 1e-12);
    EXPECT_NEAR(*told(stage, "translation_m", "b"), 0.2, 1e-12);
    for (const char* name : {"rotation_deg", "translation_m", "nees", "drift_px"})
        EXPECT_FALSE(told(stage, name)) << name;
    ASSERT_EQ(stage.notes().size(), 1U);
    EXPECT_THAT(stage.notes()[0].nearest_miss, HasSubstr("0.20000 m"));
    EXPECT_THAT(stage.notes()[0].hint, HasSubstr("one rig"));
}

TEST(TruthMetric, APoseWrittenWithSixDigitsIsTheSameRig) {
    auto stage = metric({solved(pose_off(true_pose()))});
    Eigen::Isometry3d rounded = true_pose();
    rounded.matrix() = (rounded.matrix() * 1e6).array().round().matrix() / 1e6;
    stage.give<Truth>("truth", truth_of(true_pose(), {}));
    stage.give<Truth>("truth", truth_of(rounded, {}));
    stage.fire();
    EXPECT_NEAR(*told(stage, "rotation_deg"), 0.3, 1e-9);
    EXPECT_TRUE(stage.notes().empty());
}

TEST(TruthMetric, OfSeveralCamerasOneIsChosen) {
    const auto fire = [](const std::string& camera, const std::string& lidar) {
        auto stage = metric({solved(true_pose(), "LEFT"), solved(pose_off(true_pose()), "RIGHT")});
        stage.set("camera", camera.c_str()).set("lidar", lidar.c_str());
        stage.give<Truth>("truth", truth_of(true_pose(), {}));
        stage.fire();
        return stage;
    };
    EXPECT_NEAR(*told(fire("LEFT", ""), "translation_m"), 0.0, 1e-12);
    EXPECT_NEAR(*told(fire("RIGHT", "LIDAR"), "translation_m"), 0.005, 1e-12);
    const auto open = fire("", "");
    EXPECT_EQ(figures(open), 0U);
    ASSERT_EQ(open.notes().size(), 1U);
    EXPECT_THAT(open.notes()[0].nearest_miss, HasSubstr("camera 'RIGHT'"));
    EXPECT_THAT(open.notes()[0].hint, HasSubstr("set 'camera'"));
    const auto wrong = fire("MIDDLE", "");
    EXPECT_EQ(figures(wrong), 0U);
    ASSERT_EQ(wrong.notes().size(), 1U);
    EXPECT_THAT(wrong.notes()[0].nearest_miss, HasSubstr("solved are camera 'LEFT'"));
}

TEST(TruthMetric, NothingSolvedIsTold) {
    auto none = metric({});
    none.give<Truth>("truth", truth_of(true_pose(), {}));
    none.fire();
    EXPECT_EQ(figures(none), 0U);
    ASSERT_EQ(none.notes().size(), 1U);
    EXPECT_THAT(none.notes()[0].nearest_miss, HasSubstr("no camera has extrinsics"));

    Eigen::Isometry3d broken = true_pose();
    broken.translation().x() = kNotANumber;
    auto nan = metric({solved(broken)});
    nan.give<Truth>("truth", truth_of(true_pose(), {}));
    nan.fire();
    EXPECT_EQ(figures(nan), 0U);
    EXPECT_EQ(nan.notes().size(), 1U);

    auto broken_truth = metric({solved(true_pose())});
    broken_truth.give<Truth>("truth", truth_of(broken, {}), "a");
    EXPECT_THROW(broken_truth.fire(), Error);
}

}  // namespace
}  // namespace petal
