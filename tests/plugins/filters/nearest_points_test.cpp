// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "filters/nearest_points.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "plugins/filters/cloud_samples.hpp"

namespace petal {
namespace {

using ::testing::ElementsAre;
using testing::kept_by;
using testing::Points;
using testing::StageHarness;

StageHarness nearest(double distance, double range_threshold) {
    auto stage = StageHarness::of<NearestPoints>("filter.nearest_points");
    stage.set("margin_step_deg", 1.0);
    stage.set("distance", distance).set("range_threshold", range_threshold);
    return stage;
}

/// At a range and an azimuth, on the horizon raised by a quarter of a cell of 1 deg.
std::array<float, 3> at(double range, double azimuth_deg) {
    constexpr double kRadians = 3.14159265358979323846 / 180.0;
    const double up = 0.25 * kRadians, turn = azimuth_deg * kRadians;
    return {static_cast<float>(range * std::cos(up) * std::cos(turn)),
            static_cast<float>(range * std::cos(up) * std::sin(turn)),
            static_cast<float>(range * std::sin(up))};
}

/// Cells of 1 deg end at whole degrees. One holds a margin, with a vacant point; one an even wall;
/// a third one point.
const Points kCells = {at(7.0, 10.2),   at(4.0, 10.3),  at(4.019, 10.4),
                       at(4.021, 10.5), at(5.5, 10.6),  at(7.0, 11.2),
                       at(7.01, 11.4),  at(7.02, 11.6), at(3.99, -40.5)};

TEST(NearestPointsStage, OfACellWithAMarginTheNearestStay) {
    auto stage = nearest(0.02, 0.3);
    EXPECT_THAT(kept_by(stage, kCells), ElementsAre(1, 2));
}

TEST(NearestPointsStage, WithoutAThresholdEveryCellCounts) {
    auto stage = nearest(0.015, 0.0);
    EXPECT_THAT(kept_by(stage, kCells), ElementsAre(1, 5, 6, 8));
}

TEST(NearestPointsStage, NoMarginIsNoted) {
    auto stage = nearest(0.02, 3.5);
    EXPECT_TRUE(kept_by(stage, kCells).empty());
    ASSERT_EQ(stage.notes().size(), 1U);
    EXPECT_EQ(stage.notes()[0].threshold, "range_threshold 3.5 m in cells of margin_step_deg 1");
}

TEST(NearestPointsStage, ThePointInTheOriginHasNoDirection) {
    auto stage = nearest(0.02, 0.0);
    EXPECT_THAT(kept_by(stage, {{0, 0, 0}, at(4.0, 0.5)}), ElementsAre(1));
}

TEST(NearestPointsStage, DoesWhatAllRemoversDo) {
    std::mt19937_64 engine(3);
    Points points;
    for (int i = 0; i < 20000; ++i)
        points.push_back(at(i % 3 == 0 ? 7.0F : testing::draw(engine, 4.0F, 4.1F),
                            testing::draw(engine, -35.0F, 35.0F)));
    testing::expect_good_remover([] { return nearest(0.02, 0.3); }, points);
}

}  // namespace
}  // namespace petal
