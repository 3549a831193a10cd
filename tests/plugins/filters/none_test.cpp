// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "filters/none.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "plugins/filters/cloud_samples.hpp"

namespace petal {
namespace {

using testing::StageHarness;

TEST(NoFilterStage, TheVerySamePacketGoesOn) {
    Cloud cloud = testing::cloud_of({{1, 2, 3}, {std::numeric_limits<float>::quiet_NaN(), 0, 0}});
    cloud.parts = {{0, mrpt::Clock::fromDouble(1.7e9)}};
    auto packet = make_packet(cloud, FrameInfo{});
    const void* const given = packet.value.get();
    auto stage = StageHarness::of<NoFilter>("filter.none");
    stage.give_packet("cloud", packet).fire();
    EXPECT_EQ(stage.written("cloud").at(0).value.get(), given);
    EXPECT_EQ(stage.out<Cloud>("cloud").parts.size(), 1U);
    EXPECT_TRUE(stage.notes().empty());
}

}  // namespace
}  // namespace petal
