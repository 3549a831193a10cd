// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "sinks/projection.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <opencv2/imgcodecs.hpp>

#include "plugins/sinks/judged_example.hpp"

namespace petal {
namespace {

namespace fs = std::filesystem;
using testing::StageHarness;

/// f (y / z) of the points at y = +-0.5 m, 1.9 m before the camera: 26.3 px from the middle.
constexpr int kLeft = 53, kRight = 106, kRow = 60;

TEST(ProjectionTest, NearPointsAreRedAndHiddenOnesAreNotDrawn) {
    StageHarness stage = judged_example::stage<Projection>();
    stage.set("min_range", 2.0).set("max_range", 10.0).set("point_px", 3).fire();
    const cv::Mat picture =
        cv::imread((stage.folder() / "projection" / "hall_CAMERA.png").string());
    ASSERT_EQ(picture.cols, 160);
    ASSERT_GT(picture.rows, 120);  // the scale below
    for (const int column : {kLeft, kRight}) {
        const auto dot = picture.at<cv::Vec3b>(kRow, column);
        EXPECT_GT(dot[2], 2 * dot[0]) << column;  // red, at the near end; the far one would be blue
        EXPECT_GT(dot[2], 100) << column;
    }
    // Elsewhere the photo in grey, darker.
    const auto photo = picture.at<cv::Vec3b>(20, 20);
    EXPECT_EQ(photo[0], photo[1]);
    EXPECT_EQ(photo[1], photo[2]);
}

TEST(ProjectionTest, FarPointsAreBlue) {
    StageHarness stage = judged_example::stage<Projection>();
    stage.set("min_range", 0.1).set("max_range", 2.0).fire();
    const cv::Mat picture =
        cv::imread((stage.folder() / "projection" / "hall_CAMERA.png").string());
    const auto dot = picture.at<cv::Vec3b>(kRow, kLeft);
    EXPECT_GT(dot[0], dot[2]);
}

TEST(ProjectionTest, WithoutAPoseThereIsNoPicture) {
    StageHarness stage = StageHarness::of<Projection>();
    judged_example::give(stage, Extrinsics{});
    stage.fire();
    EXPECT_EQ(stage.notes().size(), 1u);
    EXPECT_FALSE(fs::exists(stage.folder() / "projection"));
}

}  // namespace
}  // namespace petal
