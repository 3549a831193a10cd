// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

// Several cameras in one joint problem: which of them is told of what.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>
#include <optional>

#include "petal/testing/stage_harness.hpp"
#include "plugins/solvers/joint_scenes.hpp"
#include "solvers/detail/joint_report.hpp"
#include "solvers/detail/joint_search.hpp"
#include "solvers/detail/pose_starts.hpp"
#include "solvers/detail/reprojection_problem.hpp"
#include "solvers/joint.hpp"

namespace petal {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using testing::JointScenes;
using ::testing::Not;
using testing::StageHarness;

/// 'CAMERA' and, 30 cm beside it, 'SECOND', which see the same boards.
Correspondences two_cameras(const JointScenes& scenes, std::uint64_t seed) {
    Eigen::Isometry3d beside = JointScenes::true_pose();
    beside.pretranslate(Eigen::Vector3d(-0.3, 0.0, 0.0));
    Correspondences both = scenes.draw(seed);
    for (auto& seen : scenes.draw(seed, beside, "SECOND").cameras) both.cameras.push_back(seen);
    return both;
}

StageHarness solved_group(const Correspondences& seen) {
    auto stage = StageHarness::of<Joint>("solver.joint");
    stage.give<Correspondences>("correspondences", seen).fire();
    return stage;
}

TEST(JointGroup, ACameraWithoutAPoseIsNamedAndTheOtherOneSolved) {
    Correspondences both = two_cameras(JointScenes::four_diverse(), 6);
    for (auto& seen : both.cameras) {
        if (seen.camera != "SECOND") continue;
        // Barrel distortion ends the image at 0.70 f; none of these pixels has a direction.
        seen.model.distortion = mrpt::img::DistortionModel::plumb_bob;
        seen.model.k1(-0.3);
        for (auto& pair : seen.pairs) pair.image.x() += 3000.0;
        for (auto& pixel : seen.boards[0].corners_image) pixel.x() += 3000.0;
    }
    const auto stage = solved_group(both);
    const auto& cameras = stage.out<Extrinsics>("extrinsics").cameras;
    ASSERT_EQ(cameras.size(), 1U);
    EXPECT_EQ(cameras[0].camera, "CAMERA");
    EXPECT_EQ(cameras[0].degrees_of_freedom, 18);  // as if it were alone
    EXPECT_LT(
        (cameras[0].T_camera_lidar.translation() - JointScenes::true_pose().translation()).norm(),
        0.01);
    EXPECT_EQ(stage.verdict(), Level::not_usable);
    EXPECT_THAT(stage.reasons(), Contains(HasSubstr("camera 'SECOND': nothing to solve")));
    EXPECT_THAT(stage.reasons(), Not(Contains(HasSubstr("camera 'CAMERA': nothing to solve"))));
    ASSERT_EQ(stage.notes().size(), 1U);
    EXPECT_THAT(stage.notes()[0].looked_for, HasSubstr("SECOND"));
}

TEST(JointGroup, AnOutlyingSceneIsToldOfTheCameraThatItMoves) {
    Correspondences both = two_cameras(JointScenes::six_diverse(), 5);
    // The second camera's third image is off by 8 px: 80 sigma of a line.
    for (auto& seen : both.cameras)
        if (seen.camera == "SECOND" && seen.scene == 2)
            for (auto& pixel : seen.boards[0].corners_image) pixel.x() += 8.0;
    const auto stage = solved_group(both);
    EXPECT_THAT(stage.reasons(),
                Contains(HasSubstr("camera 'SECOND': scene 'c' does not fit the others")));
    EXPECT_THAT(stage.reasons(), Not(Contains(HasSubstr("camera 'CAMERA': scene 'c'"))));
}

TEST(JointGroup, AnotherPoseThatFitsBetterThanThePriorsIsToldSo) {
    JointScenes scenes = JointScenes::one_flat();
    scenes.placements[0] = {{3.5, 0.3, 0.2}, 25.0, 10.0, 0.0};
    Correspondences drawn = scenes.draw(1);
    CameraPairs& seen = drawn.cameras[0];
    const CameraModel model(seen.model);
    const auto refined =
        ReprojectionProblem(model, seen.pairs).refine_all(pose_starts(model, seen.pairs));
    ASSERT_GE(refined.size(), 2U);
    seen.order.by = DecidedBy::prior;
    seen.initial = {refined.back().T_camera_lidar};
    const auto stage = solved_group(drawn);
    EXPECT_THAT(stage.reasons(),
                Contains(HasSubstr("explains the same boards better (chi-square")));
    for (const auto& reason : stage.reasons()) EXPECT_THAT(reason, Not(HasSubstr("chi-square -")));
}

TEST(JointGroup, TheNearestOtherPoseIsToldAgainstTheBest) {
    const auto made = [](double x_first, double x_second, double squares) {
        JointSolution solution;
        solution.state.T_camera_lidar.assign(2, Eigen::Isometry3d::Identity());
        solution.state.T_camera_lidar[0].translation().x() = x_first;
        solution.state.T_camera_lidar[1].translation().x() = x_second;
        solution.squares = squares;
        return solution;
    };
    const JointSolution best = made(0.0, 0.0, 100.0);
    EXPECT_FALSE(nearest_other(best, {}).has_value());
    EXPECT_FALSE(nearest_other(best, {made(0.0, 1e-6, 100.0)}).has_value()) << "the same again";
    const auto other = nearest_other(best, {made(0.5, 0.0, 150.0), made(0.1, 0.3, 120.0)});
    ASSERT_TRUE(other.has_value());
    EXPECT_EQ(other->camera, 1U);
    EXPECT_NEAR(other->distance, 0.3, 1e-12);
    EXPECT_NEAR(other->squares, 20.0, 1e-12);
}

TEST(JointGroup, CancelEndsTheSolving) {
    const auto packet = Packet<Correspondences>{
        std::make_shared<Correspondences>(JointScenes::four_diverse().draw(1)), {}};
    const JointInput input = joint_inputs({packet}, {}).solvable.at(0);
    int polls = 0;
    Extrinsics extrinsics;
    ASSERT_TRUE(report_joint(
                    input, {}, std::nullopt, [&] { ++polls; }, extrinsics)
                    .has_value());
    EXPECT_GE(polls, 5);  // the search, and each scene left out
    // At whichever call it comes.
    for (int last = 1; last <= polls; ++last) {
        int left = last;
        const auto poll = [&] {
            if (--left == 0) throw Cancelled();
        };
        Extrinsics cancelled;
        EXPECT_THROW(report_joint(input, {}, std::nullopt, poll, cancelled), Cancelled);
    }
}

}  // namespace
}  // namespace petal
