// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "metrics/board_drift.hpp"

#include <gtest/gtest.h>

#include "plugins/metrics/table_three.hpp"

namespace petal {
namespace {

using table_three::figure_of;
using table_three::measured;

TEST(BoardDriftTest, AShiftMovesEveryCornerAlike) {
    // 2 cm to the side at 4 m with f = 800: 4 px, each corner; not 16, as the square would be.
    const auto stage =
        measured<BoardDrift>(table_three::pose({0.02, 0.0, 0.0}), table_three::pairs());
    EXPECT_NEAR(figure_of(stage, "board_drift.mean_px").value(), 4.0, 1e-9);
    EXPECT_NEAR(figure_of(stage, "board_drift.max_px").value(), 4.0, 1e-9);
    EXPECT_EQ(figure_of(stage, "board_drift.count"), 16.0);
    EXPECT_NEAR(figure_of(stage, "board_drift.mean_px", "hall").value(), 4.0, 1e-9);
    EXPECT_TRUE(stage.notes().empty());
}

TEST(BoardDriftTest, APoseWithoutIntrinsicsTakesThoseOfThePairs) {
    Extrinsics earlier = table_three::pose({0.02, 0.0, 0.0}, false);
    EXPECT_NEAR(
        *figure_of(measured<BoardDrift>(earlier, table_three::pairs()), "board_drift.mean_px"), 4.0,
        1e-9);
    earlier.cameras[0].diagnosis.emplace();
    earlier.cameras[0].diagnosis->focal = Diagnosis::FocalScale{1.01, 0.0, true};
    // The corners spread by 1 % more: those off the middle move too.
    EXPECT_GT(*figure_of(measured<BoardDrift>(earlier, table_three::pairs()), "board_drift.max_px"),
              4.2);
}

TEST(BoardDriftTest, CornersBehindTheCameraAreTold) {
    const auto stage =
        measured<BoardDrift>(table_three::pose({0.0, 0.0, -5.0}), table_three::pairs());
    EXPECT_EQ(figure_of(stage, "board_drift.count"), 0.0);
    EXPECT_FALSE(figure_of(stage, "board_drift.mean_px"));
    EXPECT_EQ(stage.notes().size(), 1u);
}

}  // namespace
}  // namespace petal
