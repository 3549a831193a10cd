// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "solvers/detail/verdict.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace petal {
namespace {

TEST(Chi2Quantile, LiesNearTheTables) {
    // 99.9 % points of the tables; the approximation's own error is told in the header.
    EXPECT_NEAR(chi2_quantile(2, 3.0902) / 13.816, 1.0, 0.024);
    EXPECT_NEAR(chi2_quantile(5, 3.0902) / 20.515, 1.0, 0.012);
    EXPECT_NEAR(chi2_quantile(26, 3.0902) / 54.052, 1.0, 0.003);
    EXPECT_EQ(chi2_quantile(0, 3.0902), 0.0);
    EXPECT_GE(chi2_quantile(1, -3.29), 0.0);
}

TEST(Verdict, WhatIsNoNumberIsNotUsable) {
    CameraExtrinsics camera;
    camera.order.by = DecidedBy::data;
    camera.covariance = 1e-8 * Matrix6d::Identity();
    camera.chi2 = camera.degrees_of_freedom = 18;
    std::vector<std::string> reasons;
    EXPECT_EQ(judge(camera, {}, reasons), Level::usable);
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const auto spoiled = [&](const auto& spoil) {
        CameraExtrinsics other = camera;
        spoil(other);
        reasons.clear();
        const Level level = judge(other, {}, reasons);
        EXPECT_FALSE(reasons.empty());
        return level;
    };
    EXPECT_EQ(spoiled([&](auto& other) { other.covariance(4, 4) = nan; }), Level::not_usable);
    EXPECT_EQ(spoiled([&](auto& other) { other.T_camera_lidar.translation().x() = nan; }),
              Level::not_usable);
    EXPECT_EQ(spoiled([&](auto& other) { other.chi2 = nan; }), Level::not_usable);
}

}  // namespace
}  // namespace petal
