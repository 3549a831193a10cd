// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "metrics/stillness.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdio>
#include <opencv2/imgproc.hpp>

#include "metrics/detail/board_motion.hpp"
#include "petal/printed.hpp"
#include "petal/testing/stage_harness.hpp"
#include "plugins/metrics/plate_world.hpp"

namespace petal {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using testing::PlateWorld;
using testing::StageHarness;

StageHarness stillness(const PlateWorld& world) {
    auto stage = StageHarness::of<StillnessMetric>("metric.stillness");
    stage.give<Cloud>("cloud", world.cloud(), "hall");
    stage.give<LidarBoards>("boards", world.boards(), "hall");
    return stage;
}

double stillness_figure(const StageHarness& stage, const std::string& name) {
    for (const Metric& metric : stage.out<Metrics>("metrics").values)
        if (metric.name == "stillness." + name && metric.scene == "hall") return metric.value;
    ADD_FAILURE() << "no " << name;
    return 0.0;
}

TEST(Stillness, AStillBoardIsNeverNamed) {
    for (unsigned seed = 1; seed <= 10; ++seed) {
        PlateWorld world;
        world.seed = seed;
        auto stage = stillness(world);
        stage.fire();
        EXPECT_TRUE(stage.out<Metrics>("metrics").findings.empty()) << "seed " << seed;
        // 6 numbers of 10 pairs of splits: the largest is seldom above 4 sigma.
        EXPECT_LT(stillness_figure(stage, "board_1.motion_mm"),
                  4.5 * stillness_figure(stage, "board_1.sigma_mm"));
        EXPECT_NEAR(stillness_figure(stage, "board_1.still_until_s"), 10.0,
                    1e-3);  // ticks of the clock
    }
}

TEST(Stillness, FiveMillimetresInTenSecondsAreNamedAlongEachAxis) {
    for (int axis = 0; axis < 3; ++axis) {
        PlateWorld world;
        world.velocity(axis) = 0.0005;
        auto stage = stillness(world);
        stage.fire();
        const auto& findings = stage.out<Metrics>("metrics").findings;
        ASSERT_EQ(findings.size(), 1U) << "axis " << axis;
        EXPECT_EQ(findings[0].level, Level::weak);
        EXPECT_THAT(findings[0].reason, AllOf(HasSubstr("hall: board 1 moved"),
                                              HasSubstr("0.0-2.0 s"), HasSubstr("8.0-10.0 s")));
        // The first and the last split are 8 s apart: 4 mm; a corner may seem to move farther.
        const double sigma = stillness_figure(stage, "board_1.sigma_mm");
        EXPECT_NEAR(stillness_figure(stage, "board_1.motion_mm"), 4.0, 3.5 * sigma);
        EXPECT_LT(sigma, 1.0);
    }
}

TEST(Stillness, TheStillPartIsTold) {
    PlateWorld world;
    world.velocity.x() = 0.005;
    world.moves_from = 6.0;
    auto stage = stillness(world);
    stage.fire();
    ASSERT_EQ(stage.out<Metrics>("metrics").findings.size(), 1U);
    EXPECT_EQ(stillness_figure(stage, "board_1.still_from_s"), 0.0);
    EXPECT_NEAR(stillness_figure(stage, "board_1.still_until_s"), 6.0, 1e-3);
    EXPECT_THAT(stage.out<Metrics>("metrics").findings[0].reason,
                HasSubstr("no motion is seen in 0.0-6.0 s"));
}

TEST(Stillness, ASplitWithoutAPoseIsNotCalledStill) {
    SplitPose pose;
    pose.covariance = 1e-8 * Matrix6d::Identity();  // 0.1 mm
    pose.sideways = true;
    const auto motion =
        board_motion({pose, pose, std::nullopt, pose, pose, pose}, 0.25, 0.25, 3.0, 0.001);
    ASSERT_TRUE(motion);
    EXPECT_FALSE(motion->moved);
    EXPECT_EQ(motion->still_begin, 3U);
    EXPECT_EQ(motion->still_end, 6U);
}

TEST(Stillness, ShortCapturesAndCloudsWithoutTimesAreNoted) {
    PlateWorld world;
    world.seconds = 3.0;
    auto brief = stillness(world);
    brief.fire();
    EXPECT_TRUE(brief.out<Metrics>("metrics").values.empty());
    ASSERT_EQ(brief.notes().size(), 1U);
    EXPECT_THAT(brief.notes()[0].nearest_miss, HasSubstr("less than two splits"));

    auto stage = StageHarness::of<StillnessMetric>("metric.stillness");
    Cloud cloud = PlateWorld{}.cloud();
    cloud.parts.clear();
    stage.give<Cloud>("cloud", cloud, "hall");
    stage.give<LidarBoards>("boards", PlateWorld{}.boards(), "hall");
    stage.fire();
    ASSERT_EQ(stage.notes().size(), 1U);
    EXPECT_THAT(stage.notes()[0].nearest_miss, HasSubstr("one message"));
}

/// A dark board with four light holes of 40 px, 80 px apart; its upper left hole corner at (x, y).
CameraImage picture_at(double x, double y, double time) {
    constexpr int kFine = 16;
    cv::Mat fine(300 * kFine / 4, 300 * kFine / 4, CV_8U, cv::Scalar(200));
    const double step = kFine / 4.0;
    for (const double left : {0.0, 80.0})
        for (const double top : {0.0, 80.0})
            cv::rectangle(fine,
                          cv::Point(static_cast<int>((x + left + 0.5) * step),
                                    static_cast<int>((y + top + 0.5) * step)),
                          cv::Point(static_cast<int>((x + left + 40.5) * step) - 1,
                                    static_cast<int>((y + top + 40.5) * step) - 1),
                          cv::Scalar(40), cv::FILLED);
    cv::Mat picture;
    cv::resize(fine, picture, {300, 300}, 0, 0, cv::INTER_AREA);
    cv::GaussianBlur(picture, picture, {0, 0}, 0.8);
    CameraImage image;
    image.image = mrpt::img::CImage(picture, mrpt::img::DEEP_COPY);
    image.stamp = mrpt::Clock::fromDouble(1.7e9 + time);
    return image;
}

Metrics of_pictures(double moved) {
    PlateWorld world;
    world.points = 2000;
    auto stage = stillness(world);
    Images images;
    images.cameras = {picture_at(60, 60, 5.0)};
    images.others = {picture_at(60, 60, 0.0), picture_at(60 + moved, 60, 10.0)};
    ImageBoards boards;
    boards.cameras.push_back({"CAMERA", {}});
    ImageBoard board;
    board.target = "four_square_holes_500mm";
    board.camera = "CAMERA";
    for (const Eigen::Vector2d& p : load_target(board.target).corners())
        board.corners.emplace_back(60.0 + 400.0 * (p.x() - 0.1), 60.0 + 400.0 * (p.y() - 0.1));
    boards.boards.push_back(board);
    stage.give<Images>("images", images, "hall").give<ImageBoards>("image_boards", boards, "hall");
    stage.fire();
    return stage.out<Metrics>("metrics");
}

TEST(Stillness, ImagesOfTheFirstAndLastMomentAreCompared) {
    // 400 px are 1 m: 2 px are 5 mm.
    for (const double px : {2.0, 5.0, 10.0, 30.0}) {
        const Metrics moved = of_pictures(px);
        ASSERT_EQ(moved.findings.size(), 1U) << px;
        EXPECT_EQ(moved.findings[0].level, Level::weak);
        const std::string length = printed("moved %.1f mm", 2.5 * px);
        EXPECT_THAT(moved.findings[0].reason,
                    AllOf(HasSubstr("image board 1 of camera 'CAMERA'"), HasSubstr(length),
                          HasSubstr("the first and the last image, 10.0 s apart")));
    }
    EXPECT_TRUE(of_pictures(0.0).findings.empty());
}

TEST(Stillness, ABoardThatIsNotFoundAgainDidNotStandStill) {
    for (const double px : {60.0, 500.0}) {  // beyond the search; out of the picture
        const Metrics gone = of_pictures(px);
        ASSERT_EQ(gone.findings.size(), 1U) << px;
        EXPECT_EQ(gone.findings[0].level, Level::weak);
        EXPECT_THAT(gone.findings[0].reason,
                    AllOf(HasSubstr("hall: image board 1 of camera 'CAMERA'"),
                          HasSubstr("too few corners (0 of 16) are found again in the last image"),
                          HasSubstr("5.0 s")));
    }
}

}  // namespace
}  // namespace petal
