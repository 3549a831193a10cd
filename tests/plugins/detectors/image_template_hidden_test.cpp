// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include <gtest/gtest.h>

#include <opencv2/imgproc.hpp>
#include <random>

#include "detectors/image_template.hpp"
#include "image_render.hpp"
#include "petal/testing/stage_harness.hpp"

namespace petal {
namespace {

using testing::board_pose;
using testing::make_camera;
using testing::Photo;
using testing::StageHarness;

const std::string kHiddenTarget = PETAL_SOURCE_DIR "/datasets/targets/four_square_holes_500mm.json";

/// A board of which something is in the way.
struct HiddenBoard {
    Target target = load_target(kHiddenTarget);
    mrpt::img::TCamera camera = make_camera(640, 480, 500.0);
    Eigen::Isometry3d pose = board_pose(target, {0.05, 0.0, 1.6}, 8.0, -6.0, 3.0);

    /// Fills the rectangle from `low` to `high` (board frame, m), however far it reaches.
    void cover(cv::Mat& pixels, const Eigen::Vector2d& low, const Eigen::Vector2d& high,
               double grey) const {
        const CameraModel model(camera);
        std::vector<cv::Point> corners;
        for (const auto& [x, y] : {std::pair<double, double>{low.x(), low.y()},
                                   {high.x(), low.y()},
                                   {high.x(), high.y()},
                                   {low.x(), high.y()}}) {
            const auto seen = model.project(pose * Eigen::Vector3d(x, y, 0.0)).value();
            corners.emplace_back(cv::saturate_cast<int>(16.0 * seen.x()),
                                 cv::saturate_cast<int>(16.0 * seen.y()));
        }
        cv::fillConvexPoly(pixels, corners, cv::Scalar(grey), cv::LINE_8, 4);
    }

    void expect_found(const Photo& photo, int min_holes) const {
        StageHarness stage = StageHarness::of<ImageTemplate>("detector.image_template");
        stage.set("target", kHiddenTarget.c_str()).set("min_holes", min_holes);
        const ImageBoards found = testing::boards_in(std::move(stage), photo.take(0.8, 1.0));
        ASSERT_EQ(found.boards.size(), 1u);
        EXPECT_LT(testing::rms_distance(found.boards[0].corners,
                                        testing::true_corners(target, CameraModel(camera), pose)),
                  0.15);
    }
};

// A sky as bright as the plate, down to the middle of the upper holes: the plate is no region, and
// what is left of those holes has its middle a quarter of a hole away. A map through all four leads
// nowhere.
TEST(ImageTemplateHidden, TwoHolesAreWholeAndTwoHalfBright) {
    HiddenBoard board;
    board.pose = board_pose(board.target, {0.05, 0.0, 1.6}, 8.0, 15.0, 3.0);
    const int horizon = cv::saturate_cast<int>(
        CameraModel(board.camera).project(board.pose * Eigen::Vector3d(0.25, 0.15, 0.0))->y());
    Photo photo(board.camera);
    photo.draw([&](cv::Mat& pixels) { pixels.rowRange(0, horizon).setTo(cv::Scalar(182.0)); })
        .add(board.target, board.pose);
    board.expect_found(photo, 2);
}

// A bar before the left holes, and its shadow over a side of the upper right one: one is whole.
TEST(ImageTemplateHidden, OneHoleIsWhole) {
    const HiddenBoard board;
    const auto& holes = board.target.holes;
    double left = 1.0, right = 0.0;
    for (const auto& hole : holes) {
        left = std::min(left, hole[0].x());
        right = std::max(right, hole[0].x());
    }
    Photo photo(board.camera);
    photo.add(board.target, board.pose).draw([&](cv::Mat& pixels) {
        board.cover(pixels, {left - 0.03, -0.3}, {left + 0.03, 0.8}, 60.0);
        board.cover(pixels, {right - 0.03, 0.0}, {right + 0.03, 0.22}, 70.0);
    });
    board.expect_found(photo, 1);
}

// Thousands of groups of bricks lie as holes do, some better than those of the board; a window's
// frame as bright as the plate keeps that from being a region.
TEST(ImageTemplateHidden, BeforeAWallOfBricks) {
    const HiddenBoard board;
    Photo photo(board.camera);
    photo
        .draw([](cv::Mat& pixels) {
            std::mt19937 random(3);
            pixels.setTo(cv::Scalar(130.0));
            for (int row = 0; row * 9 < pixels.rows; ++row)
                for (int x = row % 2 == 0 ? 0 : -11; x < pixels.cols; x += 22)
                    cv::rectangle(pixels, cv::Rect(x, row * 9, 20, 7),
                                  cv::Scalar(50.0 + static_cast<double>(random() % 40)),
                                  cv::FILLED);
            cv::rectangle(pixels, cv::Rect(340, 60, 160, 160), cv::Scalar(178.0), 12);
        })
        .add(board.target, board.pose);
    board.expect_found(photo, 2);
}

}  // namespace
}  // namespace petal
