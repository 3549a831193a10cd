// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "solvers/detail/verdict.hpp"

#include <gtest/gtest.h>

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

}  // namespace
}  // namespace petal
