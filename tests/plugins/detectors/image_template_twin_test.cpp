// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "detectors/detail/image_template_twin.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <utility>

#include "image_render.hpp"
#include "petal/calibration/se3.hpp"

namespace petal {
namespace {

using testing::board_pose;

class ImageTemplateTwin : public ::testing::Test {
   protected:
    Target target_ = load_target("four_square_holes_500mm");
    TemplateModel model_{target_};

    TemplatePose tilted(double yaw_deg) const {
        return {board_pose(target_, {0.6, -0.2, 5.0}, yaw_deg, 3.0, 2.0)};
    }
    /// A fit whose sides scatter by that, known to a mm and 2 mrad.
    FittedBoard fitted(double yaw_deg, double scatter) const {
        FittedBoard board;
        board.pose = tilted(yaw_deg);
        board.covariance.setZero();
        board.covariance.diagonal() << 1e-6, 1e-6, 1e-6, 4e-6, 4e-6, 4e-6;
        board.sides.resize(model_.sides().size());
        for (FittedSide& side : board.sides) side.samples = 40;
        board.hole_scatter = board.outline_scatter = scatter;
        return board;
    }
};

// Seen from far away two mirrored tilts differ by perspective alone: at 5 deg off the line of sight
// 0.25 m come 2 cm nearer, 0.4 % of the distance, so corners 50 px from the middle move by 0.2 px,
// inwards or outwards. A turn by twice the tilt would otherwise move them by ten times as much.
TEST_F(ImageTemplateTwin, AMirroredTiltLooksNearlyTheSame) {
    const CameraModel camera(testing::make_camera(1280, 720, 1000.0));
    const TemplatePose pose = tilted(2.0);
    const TemplatePose other = mirrored(pose, model_);
    EXPECT_GT(
        rotation_angle(pose.T_camera_board.linear().transpose() * other.T_camera_board.linear()),
        0.05);
    const auto here = testing::true_corners(target_, camera, pose.T_camera_board);
    const auto there = testing::true_corners(target_, camera, other.T_camera_board);
    EXPECT_LT(testing::rms_distance(here, there), 0.5);
    EXPECT_GT(testing::rms_distance(here, there), 0.01);
    const TemplatePose back = mirrored(other, model_);
    EXPECT_TRUE(back.T_camera_board.isApprox(pose.T_camera_board, 1e-9));
}

TEST_F(ImageTemplateTwin, TheFitWhoseSidesScatterLessIsTaken) {
    const FittedBoard good = fitted(2.0, 2e-4), bad = fitted(-2.0, 6e-4);
    for (const auto& [first, second] : {std::pair(good, bad), std::pair(bad, good)}) {
        const FittedBoard taken = of_two_tilts(first, second, model_);
        EXPECT_TRUE(taken.pose.T_camera_board.isApprox(good.pose.T_camera_board));
        // 20 sides, three times the scatter: odds of 3^-20.
        EXPECT_TRUE(taken.covariance == good.covariance);
    }
}

TEST_F(ImageTemplateTwin, WhereEitherMayBeTrueTheCovarianceSpansBoth) {
    const FittedBoard board = fitted(2.0, 2e-4);
    const FittedBoard taken = of_two_tilts(board, fitted(-2.0, 2e-4), model_);
    // Even odds: half of the squared way to the other, 4 deg about the y axis of the board.
    const double turn = 4.0 * 0.017453292519943295;
    EXPECT_NEAR(std::sqrt((taken.covariance - board.covariance).trace()), std::sqrt(0.5) * turn,
                0.01 * turn);
}

TEST_F(ImageTemplateTwin, FitsThatAreOneAndTheSameAreNotTwo) {
    const FittedBoard board = fitted(2.0, 2e-4);
    const FittedBoard taken = of_two_tilts(board, fitted(2.1, 2e-4), model_);
    EXPECT_TRUE(taken.covariance == board.covariance);
}

}  // namespace
}  // namespace petal
