// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "filters/radius_outlier.hpp"

#include <gtest/gtest.h>

#include <random>

#include "plugins/filters/cloud_samples.hpp"

namespace petal {
namespace {

using ::testing::ElementsAre;
using testing::kept_by;
using testing::Points;
using testing::StageHarness;

StageHarness ball(double radius, int min_neighbours) {
    auto stage = StageHarness::of<RadiusOutlier>("filter.radius_outlier");
    stage.set("radius", radius).set("min_neighbours", min_neighbours);
    return stage;
}

TEST(RadiusOutlierStage, TheRadiusItselfIsOutside) {
    // On both sides of the origin, where cells have their borders.
    const Points points = {{-0.25F, 0, 0}, {0.25F, 0, 0}, {0.74F, 0, 0}, {1.25F, 0, 0}};
    auto one = ball(0.5, 1);
    EXPECT_THAT(kept_by(one, points), ElementsAre(1, 2));
    auto wider = ball(0.501, 1);
    EXPECT_THAT(kept_by(wider, points), ElementsAre(0, 1, 2));
    auto two = ball(0.501, 2);
    EXPECT_THAT(kept_by(two, points), ElementsAre(1));
    auto three = ball(0.501, 3);
    EXPECT_TRUE(kept_by(three, points).empty());
    ASSERT_EQ(three.notes().size(), 1U);
    EXPECT_EQ(three.notes()[0].nearest_miss, "none of 4 points stays");
}

TEST(RadiusOutlierStage, APointIsNotItsOwnNeighbourButItsDoubleIs) {
    auto stage = ball(0.1, 1);
    EXPECT_THAT(kept_by(stage, {{1, 1, 1}, {5, 5, 5}, {1, 1, 1}}), ElementsAre(0, 2));
}

TEST(RadiusOutlierStage, PointsFartherOffThanCellsCanBeCounted) {
    auto stage = ball(0.001, 1);
    EXPECT_THAT(kept_by(stage, {{1e20F, 0, 0}, {0, 1e20F, 0}, {1e20F, 0, 0}, {-1e20F, 0, 0}}),
                ElementsAre(0, 2));
}

/// Dense and sparse parts, on all sides of the origin.
Points clumps() {
    std::mt19937_64 engine(7);
    Points points;
    for (int clump = 0; clump < 30; ++clump) {
        const float size = clump % 3 == 0 ? 0.05F : 1.0F;
        const float x = testing::draw(engine, -2, 2), y = testing::draw(engine, -2, 2);
        for (int i = 0; i < 60; ++i)
            points.push_back({x + testing::draw(engine, -size, size),
                              y + testing::draw(engine, -size, size),
                              testing::draw(engine, -size, size)});
    }
    return points;
}

TEST(RadiusOutlierStage, DoesWhatAllRemoversDo) {
    testing::expect_good_remover([] { return ball(0.2, 6); }, clumps());
}

}  // namespace
}  // namespace petal
