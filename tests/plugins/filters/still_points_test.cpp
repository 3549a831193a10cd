// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "filters/still_points.hpp"

#include <gtest/gtest.h>

#include "petal/calibration/metrics.hpp"
#include "petal/error.hpp"
#include "plugins/filters/cloud_samples.hpp"

namespace petal {
namespace {

using testing::StageHarness;

/// Ten messages, one a second, of two points each.
Cloud ten_messages() {
    testing::Points points;
    for (int i = 0; i < 20; ++i) points.push_back({static_cast<float>(i), 0.0F, 1.0F});
    Cloud cloud = testing::cloud_of(points);
    for (std::size_t i = 0; i < 10; ++i)
        cloud.parts.push_back({2 * i, mrpt::Clock::fromDouble(1.7e9 + static_cast<double>(i))});
    return cloud;
}

void tell_still(Metrics& metrics, int board, double from, double until) {
    const std::string name = "stillness.board_" + std::to_string(board);
    metrics.values.push_back({name + ".motion_mm", 5.0, "mm", "a"});
    metrics.values.push_back({name + ".still_from_s", from, "s", "a"});
    metrics.values.push_back({name + ".still_until_s", until, "s", "a"});
}

StageHarness fired(const Cloud& cloud, const Metrics& metrics) {
    auto stage = StageHarness::of<StillPoints>("filter.still_points");
    stage.give<Cloud>("cloud", cloud).give<Metrics>("metrics", metrics);
    stage.fire();
    return stage;
}

TEST(StillPointsStage, KeepsWhatAllBoardsHaveInCommonWithItsMessages) {
    Metrics metrics;
    tell_still(metrics, 1, 2.0, 10.0);
    tell_still(metrics, 2, 0.0, 6.0);
    const auto stage = fired(ten_messages(), metrics);
    const Cloud& still = stage.out<Cloud>("cloud");
    ASSERT_EQ(still.size(), 8U);  // messages 2 to 5
    EXPECT_EQ(still.scene_index.front(), 4U);
    EXPECT_EQ(still.scene_index.back(), 11U);
    EXPECT_FLOAT_EQ(still.points->getPointsBufferRef_x()[0], 4.0F);
    ASSERT_EQ(still.parts.size(), 4U);
    EXPECT_EQ(still.parts[1].begin, 2U);
    EXPECT_DOUBLE_EQ(mrpt::Clock::toDouble(still.parts[0].stamp), 1.7e9 + 2.0);
    EXPECT_TRUE(stage.notes().empty());
}

TEST(StillPointsStage, TheVerySamePacketGoesOnWhereNothingMoved) {
    Metrics metrics;
    tell_still(metrics, 1, 0.0, 10.0);
    const auto packet = make_packet(ten_messages(), FrameInfo{});
    const void* const given = packet.value.get();
    auto stage = StageHarness::of<StillPoints>("filter.still_points");
    stage.give_packet("cloud", packet).give<Metrics>("metrics", metrics).fire();
    EXPECT_EQ(stage.written("cloud").at(0).value.get(), given);
    EXPECT_TRUE(stage.notes().empty());
}

TEST(StillPointsStage, AllPointsStayWhereTooLittleIsStillAndANoteSaysSo) {
    Metrics apart;
    tell_still(apart, 1, 0.0, 4.0);
    tell_still(apart, 2, 6.0, 10.0);
    const auto never = fired(ten_messages(), apart);
    EXPECT_EQ(never.out<Cloud>("cloud").size(), 20U);
    ASSERT_EQ(never.notes().size(), 1U);
    EXPECT_EQ(never.notes()[0].nearest_miss, "the boards were never still at the same time");

    Metrics brief;
    tell_still(brief, 1, 3.0, 4.5);
    const auto stage = fired(ten_messages(), brief);
    EXPECT_EQ(stage.out<Cloud>("cloud").size(), 20U);
    ASSERT_EQ(stage.notes().size(), 1U);
    EXPECT_EQ(stage.notes()[0].nearest_miss, "only 1.5 s, from 3.0 s on (min_still 2.0 s)");

    const auto untold = fired(ten_messages(), {});
    EXPECT_EQ(untold.out<Cloud>("cloud").size(), 20U);
    ASSERT_EQ(untold.notes().size(), 1U);
    EXPECT_EQ(untold.notes()[0].nearest_miss, "the metrics tell of no board");
}

TEST(StillPointsStage, ACloudWithoutItsMessagesIsRefused) {
    Metrics metrics;
    tell_still(metrics, 1, 2.0, 10.0);
    Cloud cloud = ten_messages();
    cloud.parts.clear();
    auto stage = StageHarness::of<StillPoints>("filter.still_points");
    stage.give<Cloud>("cloud", cloud).give<Metrics>("metrics", metrics);
    EXPECT_THROW(stage.fire(), Error);
}

}  // namespace
}  // namespace petal
