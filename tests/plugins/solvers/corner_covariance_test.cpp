// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "solvers/detail/corner_covariance.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

namespace petal {
namespace {

TEST(CornerCovariance, TheJointOneIsTakenAsItIsElseTheCornersCountLess) {
    const Eigen::MatrixXd joint = 0.3 * Eigen::MatrixXd::Identity(8, 8);
    EXPECT_EQ(corner_covariance(joint, {}, 4), joint);
    Eigen::Matrix2d one;
    one << 2.0, 0.5, 0.5, 1.0;
    const Eigen::MatrixXd made = corner_covariance({}, {one, one}, 4);
    Eigen::MatrixXd expected = 4.0 * Eigen::MatrixXd::Identity(8, 8);  // 1 px^2 where none is told
    expected.block<2, 2>(0, 0) = expected.block<2, 2>(2, 2) = 4.0 * one;
    EXPECT_EQ(made, expected);
    EXPECT_EQ(corner_covariance({}, {one, one}, 4, 8.0), 2.0 * expected);
}

TEST(CornerCovariance, OnlyWhatIsNoneHasAFault) {
    Eigen::MatrixXd covariance = Eigen::MatrixXd::Identity(4, 4);
    EXPECT_EQ(covariance_fault(covariance), "");
    covariance(3, 3) = 0.0;
    EXPECT_EQ(covariance_fault(covariance), "") << "of less than full rank";
    covariance(3, 3) = -1e-9;
    EXPECT_EQ(covariance_fault(covariance), "") << "rounding";
    covariance(3, 3) = -1e-5;
    EXPECT_THAT(covariance_fault(covariance), ::testing::HasSubstr("negative variance"));
    covariance(3, 3) = std::numeric_limits<double>::quiet_NaN();
    EXPECT_THAT(covariance_fault(covariance), ::testing::HasSubstr("NaN"));
    EXPECT_EQ(covariance_fault({}), "");
    EXPECT_EQ(covariance_fault(Eigen::MatrixXd::Zero(2, 2)), "");
    EXPECT_NE(covariance_fault(-Eigen::MatrixXd::Identity(2, 2)), "");
}

}  // namespace
}  // namespace petal
