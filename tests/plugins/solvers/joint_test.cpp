// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "solvers/joint.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "petal/error.hpp"
#include "petal/testing/stage_harness.hpp"
#include "plugins/solvers/joint_scenes.hpp"
#include "plugins/solvers/real_pairs.hpp"
#include "real_data.hpp"
#include "solvers/detail/extrinsics_estimate.hpp"

namespace petal {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using testing::JointScenes;
using testing::StageHarness;

StageHarness joined(const Correspondences& scenes) {
    auto stage = StageHarness::of<Joint>("solver.joint");
    stage.give<Correspondences>("correspondences", scenes).fire();
    return stage;
}

const CameraExtrinsics& joined_camera(const StageHarness& stage, std::size_t index = 0) {
    return stage.out<Extrinsics>("extrinsics").cameras.at(index);
}

double joint_degrees(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b) {
    return kDegrees * rotation_angle(a.linear() * b.linear().transpose());
}

double joint_metres(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b) {
    return (a.translation() - b.translation()).norm();
}

std::string all_reasons(const StageHarness& stage) {
    std::string text;
    for (const auto& reason : stage.reasons()) text += reason + "\n";
    return text;
}

TEST(Joint, FindsTheTruthWithoutAGuess) {
    JointScenes scenes = JointScenes::four_diverse();
    scenes.drawn = 0.0;
    const auto stage = joined(scenes.draw(1));
    const auto& camera = joined_camera(stage);
    // No noise is drawn: what is left is the solver's convergence.
    EXPECT_LT(joint_degrees(camera.T_camera_lidar, JointScenes::true_pose()), 1e-6);
    EXPECT_LT(joint_metres(camera.T_camera_lidar, JointScenes::true_pose()), 1e-7);
    EXPECT_NEAR(camera.chi2, 0.0, 1e-6);
    EXPECT_EQ(camera.degrees_of_freedom, 18);  // 6 a board less 6
    EXPECT_EQ(camera.residuals.size(), 64u);
    ASSERT_TRUE(camera.diagnosis.has_value());
    EXPECT_EQ(camera.diagnosis->variance_scale, 1.0);  // never scaled down
}

TEST(Joint, SixDiversePlacementsAreUsable) {
    const auto stage = joined(JointScenes::six_diverse().draw(4));
    EXPECT_EQ(stage.verdict(), Level::usable) << all_reasons(stage);
    const auto& camera = joined_camera(stage);
    EXPECT_LT(joint_metres(camera.T_camera_lidar, JointScenes::true_pose()), 0.005);
    // The advice starts from the very sigmas that are told.
    ASSERT_TRUE(camera.diagnosis->advice.has_value());
    const auto& advice = *camera.diagnosis->advice;
    EXPECT_NEAR(advice.sigma_translation_before, principal_sigma(camera).translation, 1e-6);
    EXPECT_NEAR(advice.sigma_rotation_before, principal_sigma(camera).rotation, 1e-6);
    EXPECT_LT(advice.sigma_rotation_after, advice.sigma_rotation_before);
    ASSERT_EQ(camera.diagnosis->drifts.size(), 3u);
    for (const auto& drift : camera.diagnosis->drifts) EXPECT_GT(drift.considered_px, drift.px);
    EXPECT_THAT(camera.weakest_direction, HasSubstr("straight ahead at 5, 20 and 50 m"));
}

TEST(Joint, OneFlatBoardIsNeverUsable) {
    for (std::uint64_t seed = 0; seed < 5; ++seed) {
        const auto stage = joined(JointScenes::one_flat().draw(seed));
        EXPECT_NE(stage.verdict(), Level::usable);
        EXPECT_THAT(stage.reasons(), Contains(HasSubstr("weakest:")));
        EXPECT_THAT(all_reasons(stage), HasSubstr("about the camera's"));
        EXPECT_THAT(stage.reasons(), Contains(HasSubstr("what would help most next: a board")));
        EXPECT_THAT(all_reasons(stage), HasSubstr(", if the LiDAR sees it there"));
    }
}

TEST(Joint, ThreeYawOnlyPlacementsAreNeverUsable) {
    for (std::uint64_t seed = 0; seed < 5; ++seed) {
        const auto stage = joined(JointScenes::three_yaw().draw(seed));
        EXPECT_NE(stage.verdict(), Level::usable);
        EXPECT_THAT(joined_camera(stage).weakest_direction,
                    HasSubstr("together with a shift along the camera's"));
    }
}

TEST(Joint, YawAloneIsNotUsableHoweverSmallTheNoise) {
    JointScenes scenes = JointScenes::three_yaw();
    scenes.lidar_sigma = 0.0004;
    scenes.lidar_sigma_deg = 0.02;
    scenes.line_sigma_px = 0.02;
    const auto stage = joined(scenes.draw(1));
    EXPECT_LT(principal_sigma(joined_camera(stage)).rotation * kDegrees, 0.06);
    EXPECT_EQ(stage.verdict(), Level::weak);
    EXPECT_THAT(stage.reasons(), Contains(HasSubstr("about the camera's x axis, so that an error "
                                                    "about it that all share would not show")));
}

TEST(Joint, AWrongFocalLengthIsNamed) {
    for (const double factor : {1.01, 0.99}) {
        JointScenes scenes = JointScenes::four_diverse();
        scenes.lidar_sigma = 0.001;
        scenes.line_sigma_px = 0.04;
        scenes.focal_told = 920.0 * factor;
        const auto stage = joined(scenes.draw(7));
        EXPECT_NE(stage.verdict(), Level::usable);
        EXPECT_THAT(all_reasons(stage),
                    HasSubstr(factor > 1.0 ? "too long (sigma" : "too short (sigma"));
        EXPECT_THAT(all_reasons(stage), HasSubstr("check the intrinsics"));
        EXPECT_NEAR(joined_camera(stage).diagnosis->focal->scale, 1.0 / factor,
                    4.0 * joined_camera(stage).diagnosis->focal->sigma);
    }
    EXPECT_THAT(all_reasons(joined(JointScenes::four_diverse().draw(7))),
                ::testing::Not(HasSubstr("focal length")));
}

TEST(Joint, TheFocalLengthIsEstimatedWhereDepthAllows) {
    JointScenes scenes = JointScenes::six_diverse();
    scenes.focal_told = 920.0 * 1.01;
    auto stage = StageHarness::of<Joint>();
    stage.set("estimate_focal", true).give<Correspondences>("correspondences", scenes.draw(3));
    stage.fire();
    const auto& camera = joined_camera(stage);
    ASSERT_TRUE(camera.diagnosis->focal->estimated);
    EXPECT_NEAR(camera.model.fx(), 920.0, 920.0 * 4.0 * camera.diagnosis->focal->sigma);
    EXPECT_EQ(camera.degrees_of_freedom, 29);  // 36 less 6 less 1
    EXPECT_THAT(all_reasons(stage), HasSubstr("was estimated"));

    auto flat = StageHarness::of<Joint>();
    flat.set("estimate_focal", true)
        .give<Correspondences>("correspondences", JointScenes::one_flat().draw(3))
        .fire();
    EXPECT_FALSE(joined_camera(flat).diagnosis->focal->estimated);
    EXPECT_THAT(all_reasons(flat), HasSubstr("the focal length was not estimated"));
}

TEST(Joint, AnOutlyingSceneIsNamed) {
    Correspondences scenes = JointScenes::six_diverse().draw(5);
    // 3 cm sideways: 15 sigma of a board's pose.
    scenes.cameras[2].boards[0].T_lidar_board.pretranslate(Eigen::Vector3d(0.0, 0.03, 0.0));
    const auto stage = joined(scenes);
    EXPECT_NE(stage.verdict(), Level::usable);
    EXPECT_THAT(stage.reasons(), Contains(HasSubstr("scene 'c' does not fit the others")));
    const auto& told = joined_camera(stage).diagnosis->scenes;
    ASSERT_EQ(told.size(), 6u);
    for (std::size_t i = 0; i < told.size(); ++i) EXPECT_EQ(told[i].outlier, i == 2) << i;
    // The loss keeps it from moving the pose: without any it is 15 sigma / 6 and more.
    auto plain = StageHarness::of<Joint>();
    plain.set("robust_loss", "none").give<Correspondences>("correspondences", scenes).fire();
    EXPECT_LT(joint_metres(joined_camera(stage).T_camera_lidar, JointScenes::true_pose()),
              0.7 * joint_metres(joined_camera(plain).T_camera_lidar, JointScenes::true_pose()));
    EXPECT_GT(joined_camera(stage).diagnosis->variance_scale, 1.0);
}

TEST(Joint, TwoScenesThatContradictEachOtherAreBothNamed) {
    JointScenes scenes = JointScenes::four_diverse();
    scenes.placements.resize(2);
    Correspondences drawn = scenes.draw(5);
    drawn.cameras[1].boards[0].T_lidar_board.pretranslate(Eigen::Vector3d(0.0, 0.0, 0.1));
    const auto stage = joined(drawn);
    EXPECT_THAT(stage.reasons(), Contains(HasSubstr("'a' and 'b' contradict each other")));
}

TEST(Joint, InfluencesSumUpAndEverySceneIsLeftOut) {
    const auto stage = joined(JointScenes::four_diverse().draw(2));
    const auto& told = joined_camera(stage).diagnosis->scenes;
    ASSERT_EQ(told.size(), 4u);
    double sum = 0.0, chi2 = 0.0;
    for (const auto& scene : told) {
        sum += scene.influence;
        chi2 += scene.chi2;
        EXPECT_GT(scene.influence, 0.0);
        EXPECT_TRUE(scene.solvable_without);
        EXPECT_GT(scene.shift.norm(), 0.0);
        EXPECT_EQ(scene.degrees_of_freedom, 6);
        EXPECT_FALSE(scene.outlier);
    }
    EXPECT_NEAR(sum, 1.0, 1e-9);
    // The rest is that of the range offset, against its sigma.
    EXPECT_LE(chi2, joined_camera(stage).chi2);
    EXPECT_GT(chi2, joined_camera(stage).chi2 - 4.0);
    const auto single = joined(JointScenes::one_flat().draw(2));
    EXPECT_FALSE(joined_camera(single).diagnosis->scenes.at(0).solvable_without);
}

TEST(Joint, APriorIsShownApart) {
    const Eigen::Vector3d truth = JointScenes::true_pose().translation();
    auto stage = StageHarness::of<Joint>();
    stage.set("prior_sigma", 0.002)
        .set("prior_translation", Value(std::vector<double>{truth.x(), truth.y(), truth.z()}))
        .give<Correspondences>("correspondences", JointScenes::one_flat().draw(8));
    stage.fire();
    const auto& camera = joined_camera(stage);
    ASSERT_TRUE(camera.diagnosis->prior.has_value());
    CameraExtrinsics alone = camera;
    alone.covariance = camera.diagnosis->prior->covariance_without_prior;
    EXPECT_LE(principal_sigma(camera).translation, 0.0021);
    EXPECT_GT(principal_sigma(alone).translation, 0.01);
    EXPECT_NE(stage.verdict(), Level::usable) << all_reasons(stage);

    // 10 cm off, told as 5 mm: four diverse placements know better.
    stage = StageHarness::of<Joint>();
    stage.set("prior_sigma", 0.005)
        .set("prior_translation", Value(std::vector<double>{truth.x() + 0.1, truth.y(), truth.z()}))
        .give<Correspondences>("correspondences", JointScenes::four_diverse().draw(8));
    stage.fire();
    EXPECT_THAT(stage.reasons(), Contains(HasSubstr("the data contradict the prior")));
    EXPECT_GT(joined_camera(stage).diagnosis->prior->sigmas, 5.0);
    stage.set("prior_camera", "OTHER");
    EXPECT_THROW(stage.fire(), Error);
    EXPECT_THROW(stage.set("prior_translation", Value(std::vector<double>{1.0})).fire(), Error);
}

TEST(Joint, TwoCamerasShareTheirBoards) {
    const JointScenes scenes = JointScenes::four_diverse();
    Eigen::Isometry3d beside = JointScenes::true_pose();
    beside.pretranslate(Eigen::Vector3d(-0.3, 0.0, 0.0));
    Correspondences both = scenes.draw(6);
    Correspondences second = scenes.draw(6, beside, "SECOND");
    for (auto& seen : second.cameras) {
        // It took the board's corners from another side: a quarter turn about the centre.
        Eigen::Isometry3d turn = Eigen::Isometry3d::Identity();
        turn.linear() = Eigen::AngleAxisd(kPi / 2.0, Eigen::Vector3d::UnitZ()).toRotationMatrix();
        const Eigen::Vector3d centre(0.25, 0.25, 0.0);
        turn.translation() = centre - turn.linear() * centre;
        auto& board = seen.boards[0];
        board.T_lidar_board = board.T_lidar_board * turn;
        for (auto& corner : board.corners_board) corner = turn.inverse() * corner;
        both.cameras.push_back(seen);
    }
    const auto stage = joined(both);
    ASSERT_EQ(stage.out<Extrinsics>("extrinsics").cameras.size(), 2u);
    EXPECT_LT(joint_metres(joined_camera(stage, 0).T_camera_lidar, JointScenes::true_pose()), 0.01);
    EXPECT_LT(joint_metres(joined_camera(stage, 1).T_camera_lidar, beside), 0.01);
    EXPECT_EQ(joined_camera(stage).degrees_of_freedom, 36);  // 6 times 8 views less 12
    // The LiDAR's noise of a shared board is drawn once: chi-square of 36 within 99.9 %.
    EXPECT_LT(joined_camera(stage).chi2, 68.0);
}

TEST(Joint, PosesWithoutACovarianceAreToldAndWeak) {
    Correspondences scenes = JointScenes::six_diverse().draw(4);
    for (auto& seen : scenes.cameras) {
        seen.boards[0].pose_covariance.reset();
        seen.boards[0].image_covariance.resize(0, 0);
    }
    auto stage = StageHarness::of<Joint>();
    stage.set("assumed_board_sigma", 0.001)
        .set("assumed_board_sigma_deg", 0.05)
        .give<Correspondences>("correspondences", scenes);
    stage.fire();
    EXPECT_EQ(stage.verdict(), Level::weak);
    EXPECT_THAT(stage.reasons(), Contains(HasSubstr("came without a covariance")));
}

TEST(Joint, PublishedCampusBoardsAreNoCalibrationAndTheDirectionIsNamed) {
    PETAL_NEEDS_REAL_DATA();
    CameraPairs seen;
    seen.camera = "CAMERA";
    seen.lidar = "LIDAR";
    seen.model = testing::campus_camera();
    seen.pairs = testing::campus_pairs(testing::real_data());
    seen.pairs.erase(seen.pairs.begin(), seen.pairs.begin() + 10);
    seen.order.by = DecidedBy::given;
    const auto stage = joined(Correspondences{{seen}});
    // The pose is known to lie 5.9 deg off; the sigma says as much.
    EXPECT_NE(stage.verdict(), Level::usable) << all_reasons(stage);
    EXPECT_NEAR(principal_sigma(joined_camera(stage)).rotation * kDegrees, 5.9, 1.5);
    EXPECT_THAT(joined_camera(stage).weakest_direction,
                HasSubstr("tilting about the camera's x axis"));
}

TEST(Joint, NothingToSolveIsTold) {
    Correspondences few = JointScenes::one_flat().draw(1);
    few.cameras[0].pairs.resize(3);
    few.cameras[0].boards.clear();
    const auto stage = joined(few);
    EXPECT_TRUE(stage.out<Extrinsics>("extrinsics").cameras.empty());
    EXPECT_EQ(stage.verdict(), Level::not_usable);
    ASSERT_EQ(stage.notes().size(), 1u);
    EXPECT_THAT(stage.notes()[0].nearest_miss, HasSubstr("3 pairs"));
    EXPECT_EQ(joined(Correspondences{}).verdict(), Level::not_usable);
}

TEST(Joint, BadCovariancesAreRefusedAndNamed) {
    const auto refused = [](const auto& spoil) -> std::string {
        Correspondences scenes = JointScenes::four_diverse().draw(1);
        spoil(scenes.cameras[1].boards[0]);
        try {
            joined(scenes);
        } catch (const Error& error) {
            return error.what();
        }
        return "accepted";
    };
    EXPECT_THAT(refused([](auto& board) { board.pose_covariance->setZero(); }),
                HasSubstr("scene 'b'"));
    EXPECT_THAT(refused([](auto& board) { board.image_covariance.setZero(); }),
                HasSubstr("rank 0"));
    EXPECT_THAT(refused([](auto& board) {
                    // Twice as far from independent as can be: one direction below zero.
                    auto& covariance = board.image_covariance;
                    covariance(4, 5) = covariance(5, 4) =
                        2.0 * std::sqrt(covariance(4, 4) * covariance(5, 5));
                }),
                HasSubstr("negative"));
    EXPECT_THAT(refused([](auto& board) { board.image_covariance.resize(4, 4); }),
                HasSubstr("not 32 x 32"));
    EXPECT_THAT(refused([](auto& board) { board.corners_image.pop_back(); }),
                HasSubstr("15 pixels"));
    EXPECT_THAT(refused([](auto& board) {
                    board.corners_image[3].x() = std::numeric_limits<double>::quiet_NaN();
                }),
                HasSubstr("NaN"));
}

TEST(Joint, TheSameBytesForAnyNumberOfThreads) {
    const Correspondences scenes = JointScenes::six_diverse().draw(9);
    const auto one = joined(scenes);
    auto four = StageHarness::of<Joint>();
    four.threads(4).give<Correspondences>("correspondences", scenes).fire();
    EXPECT_EQ(joined_camera(one).T_camera_lidar.matrix(),
              joined_camera(four).T_camera_lidar.matrix());
    EXPECT_EQ(joined_camera(one).covariance, joined_camera(four).covariance);
    EXPECT_EQ(one.reasons(), four.reasons());
}

}  // namespace
}  // namespace petal
