// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "solvers/detail/placement_tilt.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "petal/calibration/angles.hpp"

namespace petal {
namespace {

using ::testing::HasSubstr;

/// Of a board ahead of the camera, turned to the side and leaning.
Eigen::Vector3d normal(double yaw_deg, double pitch_deg) {
    const double yaw = yaw_deg / kDegrees, pitch = pitch_deg / kDegrees;
    return {std::sin(yaw) * std::cos(pitch), std::sin(pitch), std::cos(yaw) * std::cos(pitch)};
}

TEST(PlacementTilt, IsTheSmallerOfTheTwoSpreads) {
    const auto tilt = least_tilt({normal(20, 6), normal(-20, 6), normal(20, -6), normal(-20, -6)});
    ASSERT_TRUE(tilt.has_value());
    EXPECT_NEAR(tilt->spread * kDegrees, 6.0, 1e-9);  // sin(pitch) is the very component along y
    EXPECT_NEAR(std::abs(tilt->axis.x()), 1.0, 1e-9);
}

TEST(PlacementTilt, YawAloneNamesTheAxisAndWhatToAdd) {
    const auto tilt = least_tilt({normal(20, 10), normal(0, 10.3), normal(-20, 10)});
    ASSERT_TRUE(tilt.has_value());
    EXPECT_LT(tilt->spread * kDegrees, 1.0);
    const auto doubt = tilt_doubt(*tilt, 5.0);
    ASSERT_TRUE(doubt.has_value());
    EXPECT_THAT(*doubt, HasSubstr("about the camera's x axis"));
    EXPECT_THAT(*doubt, HasSubstr("leans forwards or backwards"));
    EXPECT_FALSE(tilt_doubt(*tilt, 0.0).has_value());
}

TEST(PlacementTilt, PitchAloneAsksForABoardTurnedToTheSide) {
    const auto doubt =
        tilt_doubt(least_tilt({normal(0, 20), normal(0, 0), normal(0, -20)}).value(), 5.0);
    ASSERT_TRUE(doubt.has_value());
    EXPECT_THAT(*doubt, HasSubstr("about the camera's y axis"));
    EXPECT_THAT(*doubt, HasSubstr("turned to the left or right"));
}

TEST(PlacementTilt, NeedsTwoNormalsThatDoNotCancelOut) {
    EXPECT_FALSE(least_tilt({}).has_value());
    EXPECT_FALSE(least_tilt({normal(0, 0)}).has_value());
    EXPECT_FALSE(least_tilt({Eigen::Vector3d::UnitZ(), -Eigen::Vector3d::UnitZ()}).has_value());
    // Two boards always lie in one plane with each other: about one axis they tell nothing.
    EXPECT_NEAR(least_tilt({normal(20, 0), normal(0, 20)})->spread, 0.0, 1e-6);
}

}  // namespace
}  // namespace petal
