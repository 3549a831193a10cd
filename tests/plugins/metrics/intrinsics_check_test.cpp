// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "metrics/intrinsics_check.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <limits>

#include "metrics/detail/intrinsics_figures.hpp"
#include "petal/calibration/camera_model.hpp"
#include "petal/calibration/target.hpp"
#include "petal/testing/stage_harness.hpp"

namespace petal {
namespace {

using mrpt::img::TCamera;
using ::testing::AllOf;
using ::testing::HasSubstr;
using testing::StageHarness;

TCamera good() {
    TCamera camera;
    camera.ncols = 1280;
    camera.nrows = 720;
    camera.setIntrinsicParamsFromValues(900.0, 900.0, 645.0, 355.0);
    camera.distortion = mrpt::img::DistortionModel::plumb_bob;
    camera.dist.fill(0.0);
    camera.k1(-0.2);
    camera.k2(0.05);
    return camera;
}

Images image_of(const TCamera& camera) {
    CameraImage image;
    image.image = mrpt::img::CImage(1280, 720, mrpt::img::CH_GRAY);
    image.camera = camera;
    return Images{{image}};
}

/// A board near the upper right corner, as a camera with these intrinsics sees it.
ImageBoards board_of(const TCamera& camera) {
    const CameraModel model(camera);
    ImageBoard board;
    board.target = "four_square_holes_500mm";
    board.camera = "CAMERA";
    for (const Eigen::Vector2d& p : load_target(board.target).corners())
        board.corners.push_back(*model.project({0.55 + p.x(), -0.65 + p.y(), 2.0}));
    board.covariance.assign(16, 0.01 * Eigen::Matrix2d::Identity());
    return ImageBoards{{CameraInfo{"CAMERA", camera}}, {board}};
}

Metrics checked(const TCamera& told, const std::optional<ImageBoards>& boards = {}) {
    auto stage = StageHarness::of<IntrinsicsCheck>("metric.intrinsics_check");
    stage.give<Images>("images", image_of(told), "hall");
    if (boards) stage.give<ImageBoards>("image_boards", *boards, "hall");
    stage.fire();
    return stage.out<Metrics>("metrics");
}

void expect_finding(const std::function<void(TCamera&)>& spoil, Level level,
                    const std::string& text) {
    TCamera camera = good();
    spoil(camera);
    const Metrics metrics = checked(camera);
    ASSERT_EQ(metrics.findings.size(), 1U) << text;
    EXPECT_EQ(metrics.findings[0].level, level) << text;
    EXPECT_THAT(metrics.findings[0].reason, AllOf(HasSubstr("camera 'CAMERA'"), HasSubstr(text)));
}

TEST(IntrinsicsCheckStage, GoodOnesAreNotNamed) {
    const Metrics metrics = checked(good(), board_of(good()));
    EXPECT_TRUE(metrics.findings.empty());
    ASSERT_EQ(metrics.values.size(), 2U);
    EXPECT_EQ(metrics.values[0].name, "intrinsics.CAMERA.bend_px");
    EXPECT_LT(metrics.values[0].value, 1e-6);
}

TEST(IntrinsicsCheckStage, WhatIsNoCameraOrOfAnotherSizeIsNotUsable) {
    expect_finding([](TCamera& c) { c.fx(0.0); }, Level::not_usable, "are no camera");
    expect_finding([](TCamera& c) { c.cx(std::numeric_limits<double>::quiet_NaN()); },
                   Level::not_usable, "are no camera");
    expect_finding([](TCamera& c) { c.ncols = 640; }, Level::not_usable,
                   "for images of 640 x 720 px, but this one has 1280 x 720");
    expect_finding([](TCamera& c) { c.cx(1300.0); }, Level::not_usable, "outside the image");
    expect_finding([](TCamera& c) { c.cy(500.0); }, Level::weak, "px from the middle");
}

TEST(IntrinsicsCheckStage, DistortionThatFoldsInsideTheImageIsNamed) {
    // r (1 + k1 r^2) turns back at r = 1 / sqrt(-3 k1) = 0.61, where it is 0.41: 366 px of 741.
    expect_finding(
        [](TCamera& c) {
            c.k1(-0.9);
            c.k2(0.0);
        },
        Level::weak, "turns back");
    TCamera camera = good();
    camera.k1(-0.9);
    camera.k2(0.0);
    const auto fold = fold_inside_image(CameraModel(camera));
    ASSERT_TRUE(fold.has_value());
    EXPECT_NEAR(fold->fold_px, 900.0 * 2.0 / 3.0 / std::sqrt(2.7), 1.0);
    EXPECT_FALSE(fold_inside_image(CameraModel(good())).has_value());
}

TEST(IntrinsicsCheckStage, EdgesThatStayBentAreNamed) {
    TCamera other = good();
    other.k1(0.25);
    const Metrics metrics = checked(other, board_of(good()));
    ASSERT_EQ(metrics.findings.size(), 1U);
    EXPECT_THAT(metrics.findings[0].reason, HasSubstr("edges are bent by"));
    EXPECT_EQ(metrics.findings[0].level, Level::weak);
}

}  // namespace
}  // namespace petal
