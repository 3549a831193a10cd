// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "filters/statistical_outlier.hpp"

#include <gtest/gtest.h>

#include "plugins/filters/cloud_samples.hpp"

namespace petal {
namespace {

using ::testing::ElementsAre;
using testing::kept_by;
using testing::Points;
using testing::StageHarness;

StageHarness judged(int neighbours, double max_deviations) {
    auto stage = StageHarness::of<StatisticalOutlier>("filter.statistical_outlier");
    stage.set("neighbours", neighbours).set("max_deviations", max_deviations);
    return stage;
}

TEST(StatisticalOutlierStage, MeanAndDeviationByHand) {
    // Distances to the nearest: 1, 1, 1, 1, 6. Mean 2, standard deviation 2: 6 is two above.
    const Points points = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}, {9, 0, 0}};
    auto narrow = judged(1, 1.999);
    EXPECT_THAT(kept_by(narrow, points), ElementsAre(0, 1, 2, 3));
    auto wide = judged(1, 2.001);
    EXPECT_EQ(kept_by(wide, points).size(), 5U);
    // To the nearest two, their mean: 1.5, 1, 1, 1.5, 6.5. Mean 2.3: only the last is above.
    auto two = judged(2, 0.0);
    EXPECT_THAT(kept_by(two, points), ElementsAre(0, 1, 2, 3));
}

TEST(StatisticalOutlierStage, WhereAllAreAlikeAllStay) {
    Points grid;
    for (int i = 0; i < 1000; ++i)
        grid.push_back({static_cast<float>(i % 10), static_cast<float>(i / 10 % 10),
                        static_cast<float>(i / 100)});
    auto stage = judged(1, 0.0);
    EXPECT_EQ(kept_by(stage, grid).size(), grid.size());
}

TEST(StatisticalOutlierStage, FewerPointsThanNeighbours) {
    auto two = judged(8, 0.0);
    EXPECT_THAT(kept_by(two, {{1, 0, 0}, {2, 0, 0}}), ElementsAre(0, 1));
    auto one = judged(8, 100.0);
    EXPECT_TRUE(kept_by(one, {{1, 0, 0}}).empty());
    EXPECT_EQ(one.notes().size(), 1U);
}

TEST(StatisticalOutlierStage, DoesWhatAllRemoversDo) {
    Points points;
    for (int i = 0; i < 20000; ++i)
        points.push_back({0.01F * static_cast<float>(i % 200), 0.01F * static_cast<float>(i / 200),
                          i % 500 == 250 ? 1.0F : 0.0F});
    testing::expect_good_remover([] { return judged(8, 3.0); }, points);
}

}  // namespace
}  // namespace petal
