// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "metrics/agreement.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "metrics/detail/pose_agreement.hpp"
#include "petal/calibration/angles.hpp"
#include "petal/calibration/correspondences.hpp"
#include "petal/calibration/extrinsics.hpp"
#include "petal/calibration/metrics.hpp"
#include "petal/calibration/target.hpp"
#include "petal/error.hpp"
#include "petal/testing/stage_harness.hpp"

namespace petal {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using testing::StageHarness;

mrpt::img::TCamera pinhole() {
    mrpt::img::TCamera camera;
    camera.ncols = 1280;
    camera.nrows = 720;
    camera.setIntrinsicParamsFromValues(900.0, 900.0, 640.0, 360.0);
    return camera;
}

Eigen::Isometry3d agreement_mounting() {
    Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
    T.linear() << 0, -1, 0, 0, 0, -1, 1, 0, 0;
    T.translation() << 0.04, -0.1, 0.02;
    return T;
}

/// Two boards 3 m ahead; the image lists each from another corner than the LiDAR does, and the
/// second board first.
struct TwoBoards {
    LidarBoards lidar{"LIDAR", {}};
    ImageBoards image;

    /// `focal`: the camera's true focal length, as a factor of the given one.
    explicit TwoBoards(double focal = 1.0) {
        mrpt::img::TCamera seen_by = pinhole();
        seen_by.fx(focal * seen_by.fx());
        seen_by.fy(focal * seen_by.fy());
        const CameraModel model(seen_by);
        image.cameras.push_back({"CAMERA", pinhole()});
        const auto corners = load_target("four_square_holes_500mm").corners();
        for (const double left : {1.0, -0.3}) {
            LidarBoard board;
            board.target = "four_square_holes_500mm";
            board.T_lidar_board.linear() << 0, 0, 1, -1, 0, 0, 0, -1, 0;
            board.T_lidar_board.translation() << 3.0, left, 0.3;
            board.covariance = 4e-6 * Matrix6d::Identity();
            ImageBoard seen;
            seen.target = board.target;
            seen.camera = "CAMERA";
            for (const Eigen::Vector2d& p : corners)
                board.corners.push_back(board.T_lidar_board * Eigen::Vector3d(p.x(), p.y(), 0.0));
            for (auto corner = board.corners.rbegin(); corner != board.corners.rend(); ++corner)
                seen.corners.push_back(*model.project(agreement_mounting() * *corner));
            seen.covariance.assign(16, 0.04 * Eigen::Matrix2d::Identity());
            lidar.boards.push_back(board);
            image.boards.insert(image.boards.begin(), seen);
        }
    }
};

Extrinsics known(double turned_deg, const std::string& camera = "CAMERA") {
    CameraExtrinsics one;
    one.camera = camera;
    one.lidar = "LIDAR";
    one.T_camera_lidar =
        Eigen::AngleAxisd(turned_deg / kDegrees, Eigen::Vector3d::UnitY()) * agreement_mounting();
    one.covariance = 1e-6 * Matrix6d::Identity();  // 1 mm and 0.06 deg
    return Extrinsics{{one}, Level::usable, {}};
}

StageHarness held(const Extrinsics& extrinsics, const TwoBoards& boards = TwoBoards()) {
    auto stage = StageHarness::of<AgreementMetric>("metric.agreement");
    stage.give<Extrinsics>("known", extrinsics);
    stage.give<LidarBoards>("lidar", boards.lidar, "hall");
    stage.give<ImageBoards>("image", boards.image, "hall");
    return stage;
}

double agreement_figure(const StageHarness& stage, const std::string& name) {
    for (const Metric& metric : stage.out<Metrics>("metrics").values)
        if (metric.name == "agreement." + name) return metric.value;
    ADD_FAILURE() << "no " << name;
    return 0.0;
}

TEST(Agreement, RightExtrinsicsAgree) {
    auto stage = held(known(0.0));
    stage.fire();
    EXPECT_EQ(stage.verdict(), Level::usable);
    EXPECT_TRUE(stage.reasons().empty());
    EXPECT_EQ(agreement_figure(stage, "boards"), 2.0);
    EXPECT_LT(agreement_figure(stage, "reprojection_rms_px"), 1e-9);
    EXPECT_LT(agreement_figure(stage, "drift_sigmas"), 0.0);
    const CameraPairs& pairs = stage.out<Correspondences>("correspondences").cameras.at(0);
    EXPECT_EQ(pairs.scene_name, "hall");
    ASSERT_EQ(pairs.boards.size(), 2U);
    EXPECT_EQ(pairs.pairs.size(), 32U);
    for (const auto& board : pairs.boards) EXPECT_EQ(board.lidar + board.image, 1);
    EXPECT_EQ(stage.out<Extrinsics>("extrinsics").cameras.at(0).residuals.size(), 32U);
}

TEST(Agreement, HalfADegreeIsTold) {
    auto stage = held(known(0.5));
    stage.fire();
    EXPECT_EQ(stage.verdict(), Level::weak);
    ASSERT_EQ(stage.reasons().size(), 1U);
    EXPECT_THAT(stage.reasons()[0],
                AllOf(HasSubstr("camera 'CAMERA': the new data do not agree"), HasSubstr("px")));
    // 0.5 deg at 900 px are 7.9 px, a little more off the middle.
    EXPECT_NEAR(agreement_figure(stage, "reprojection_rms_px"), 8.2, 0.5);
    EXPECT_NEAR(agreement_figure(stage, "drift_rotation_deg"), 0.5, 0.15);
    EXPECT_GT(agreement_figure(stage, "drift_sigmas"), 3.0);
}

TEST(Agreement, AVagueResultThatAllowsTheMissIsWeak) {
    Extrinsics vague = known(0.5);
    vague.cameras[0].covariance = 1e-3 * Matrix6d::Identity();  // 32 mm and 1.8 deg
    auto stage = held(vague);
    stage.fire();
    EXPECT_LT(agreement_figure(stage, "drift_sigmas"), 3.0);
    EXPECT_EQ(stage.verdict(), Level::weak);
    ASSERT_EQ(stage.reasons().size(), 2U);
    EXPECT_THAT(stage.reasons()[0], AllOf(HasSubstr("the result's 1 sigma is up to 31.8 mm"),
                                          HasSubstr("usable up to 5.0 mm and 0.06 deg")));
    EXPECT_THAT(stage.reasons()[1], AllOf(HasSubstr("agrees only because"), HasSubstr("8.2 px")));

    // On the pixel, but nothing is proved.
    vague.cameras[0].T_camera_lidar = agreement_mounting();
    auto exact = held(vague);
    exact.fire();
    EXPECT_EQ(exact.verdict(), Level::weak);
    EXPECT_EQ(exact.reasons().size(), 1U);
}

TEST(Agreement, AResultThatWasNotUsableDoesNotBecomeSo) {
    for (const Level level : {Level::weak, Level::not_usable}) {
        Extrinsics poor = known(0.0);
        poor.level = level;
        poor.reasons = {"one board only"};
        auto stage = held(poor);
        stage.fire();
        EXPECT_EQ(stage.verdict(), level);
        ASSERT_EQ(stage.reasons().size(), 1U);
        EXPECT_EQ(stage.reasons()[0], std::string("the result itself was ") +
                                          (level == Level::weak ? "weak" : "not usable") +
                                          ": one board only");
    }
}

TEST(Agreement, BoardsThatContradictEachOtherAreWeak) {
    // The common drift of +8 px and -8 px is nearly none.
    TwoBoards boards;
    for (auto& corner : boards.image.boards[0].corners) corner.x() += 8.0;
    for (auto& corner : boards.image.boards[1].corners) corner.x() -= 8.0;
    auto stage = held(known(0.0), boards);
    stage.fire();
    EXPECT_LT(agreement_figure(stage, "drift_sigmas"), 3.0);
    EXPECT_GT(agreement_figure(stage, "contradiction_sigmas"), 3.1);
    EXPECT_EQ(stage.verdict(), Level::weak);
    ASSERT_EQ(stage.reasons().size(), 1U);
    EXPECT_THAT(stage.reasons()[0],
                AllOf(HasSubstr("the boards contradict each other"), HasSubstr("8.00 px")));

    // Half a pixel is what 2 mm at 3 m allow.
    auto agrees = held(known(0.0));
    agrees.fire();
    EXPECT_LT(agreement_figure(agrees, "contradiction_sigmas"), 0.0);
}

TEST(Agreement, AFocalLengthThatTheResultEstimatedIsApplied) {
    Extrinsics with_focal = known(0.0);
    const TwoBoards boards(1.02);
    auto without = held(with_focal, boards);
    without.fire();
    EXPECT_GT(agreement_figure(without, "reprojection_rms_px"), 2.0);

    Diagnosis diagnosis;
    diagnosis.covariance_considered = with_focal.cameras[0].covariance;
    diagnosis.focal = Diagnosis::FocalScale{1.02, 0.001, true};
    with_focal.cameras[0].diagnosis = diagnosis;
    auto stage = held(with_focal, boards);
    stage.fire();
    EXPECT_LT(agreement_figure(stage, "reprojection_rms_px"), 1e-9);
    const CameraExtrinsics& camera = stage.out<Extrinsics>("extrinsics").cameras.at(0);
    EXPECT_NEAR(camera.model.fx(), 918.0, 1e-9);
    ASSERT_TRUE(camera.diagnosis && camera.diagnosis->focal) << "the next one needs it too";

    with_focal.cameras[0].diagnosis->focal->estimated = false;
    auto told_only = held(with_focal, boards);
    told_only.fire();
    EXPECT_GT(agreement_figure(told_only, "reprojection_rms_px"), 2.0);
}

TEST(Agreement, OtherIntrinsicsInALaterSceneAreRefused) {
    auto stage = held(known(0.0));
    TwoBoards other;
    other.image.cameras[0].camera.fx(905.0);
    stage.give<LidarBoards>("lidar", other.lidar, "yard");
    stage.give<ImageBoards>("image", other.image, "yard");
    try {
        stage.fire();
        FAIL() << "accepted";
    } catch (const Error& error) {
        EXPECT_THAT(error.what(),
                    AllOf(HasSubstr("camera 'CAMERA' has other intrinsics in scene 'yard'"),
                          HasSubstr("the same intrinsics")));
    }
}

TEST(Agreement, FarOffOrWithoutBoardsThereIsNothingToCompare) {
    auto far = held(known(50.0));
    far.fire();
    EXPECT_EQ(far.verdict(), Level::not_usable);
    EXPECT_THAT(far.reasons().at(0), HasSubstr("the LiDAR has 2 boards and the camera 2"));
    TwoBoards none;
    none.lidar.boards.clear();
    auto stage = held(known(0.0), none);
    stage.fire();
    EXPECT_EQ(stage.verdict(), Level::not_usable);
}

TEST(Agreement, DataOfAnotherCameraOrLidarAreRefused) {
    const auto refusal = [](StageHarness stage) -> std::string {
        try {
            stage.fire();
        } catch (const Error& error) {
            return error.what();
        }
        return "accepted";
    };
    EXPECT_THAT(refusal(held(known(0.0, "LEFT"))),
                AllOf(HasSubstr("of camera 'LEFT'"), HasSubstr("the data have 'CAMERA'")));
    TwoBoards other;
    other.lidar.lidar = "ROOF";
    EXPECT_THAT(refusal(held(known(0.0), other)),
                AllOf(HasSubstr("of LiDAR 'LIDAR'"), HasSubstr("'ROOF'")));
}

TEST(Agreement, DeviateOfChiSquare) {
    // 16.81 is the 99 % point of 6 degrees of freedom, 2.326 the normal's.
    EXPECT_NEAR(deviate_of_chi2(16.81, 6), 2.326, 0.02);
    EXPECT_NEAR(deviate_of_chi2(5.348, 6), 0.0, 0.02);
}

}  // namespace
}  // namespace petal
