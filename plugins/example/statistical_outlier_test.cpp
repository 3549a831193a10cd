// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "statistical_outlier.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <memory>

#include "petal/calibration/cloud.hpp"
#include "petal/calibration/testing/contract_samples.hpp"
#include "petal/testing/contract_suite.hpp"
#include "petal/testing/stage_harness.hpp"

namespace {

using example::StatisticalOutlier;
using petal::Cloud;
using petal::testing::StageHarness;

/// A flat grid of 10 by 10 points, 1 cm apart, and one point 1 m above it: the last.
Cloud grid_and_outlier() {
    auto points = std::make_shared<mrpt::maps::CPointsMapXYZI>();
    for (int i = 0; i < 100; ++i) {
        points->insertPointFast(0.01F * static_cast<float>(i % 10),
                                0.01F * static_cast<float>(i / 10), 0.0F);
        points->setPointIntensity(points->size() - 1, static_cast<float>(i));
    }
    points->insertPointFast(0.05F, 0.05F, 1.0F);
    points->setPointIntensity(points->size() - 1, 100.0F);
    points->mark_as_modified();
    Cloud cloud;
    cloud.points = points;
    return cloud;
}

TEST(StatisticalOutlier, DropsThePointFarFromAllOthers) {
    auto stage = StageHarness::of<StatisticalOutlier>();
    stage.set("max_deviations", 3.0).give<Cloud>("cloud", grid_and_outlier());
    stage.fire();
    const auto& kept = stage.out<Cloud>("cloud");
    ASSERT_EQ(kept.size(), 100U);
    ASSERT_EQ(kept.scene_index.size(), 100U);
    for (std::uint32_t i = 0; i < 100; ++i) {
        EXPECT_EQ(kept.scene_index[i], i);
        EXPECT_EQ(kept.points->getPointIntensity(i), static_cast<float>(i));
    }
}

TEST(StatisticalOutlier, PassesOnWhereThePointsCameFrom) {
    Cloud cloud = grid_and_outlier();
    for (std::uint32_t i = 0; i < 101; ++i) cloud.scene_index.push_back(1000 + i);
    auto stage = StageHarness::of<StatisticalOutlier>();
    stage.set("max_deviations", 3.0).give<Cloud>("cloud", cloud);
    stage.fire();
    EXPECT_EQ(stage.out<Cloud>("cloud").scene_index.front(), 1000U);
}

TEST(StatisticalOutlier, DropsPointsThatAreNotFinite) {
    auto points = std::make_shared<mrpt::maps::CPointsMapXYZI>(*grid_and_outlier().points);
    points->insertPointFast(std::numeric_limits<float>::quiet_NaN(), 0.0F, 0.0F);
    Cloud cloud;
    cloud.points = points;
    auto stage = StageHarness::of<StatisticalOutlier>();
    stage.set("max_deviations", 3.0).give<Cloud>("cloud", cloud);
    stage.fire();
    EXPECT_EQ(stage.out<Cloud>("cloud").size(), 100U);
}

TEST(StatisticalOutlier, NotesThatNothingIsLeftOfACloudWithoutNeighbours) {
    for (const int count : {0, 1}) {
        auto points = std::make_shared<mrpt::maps::CPointsMapXYZI>();
        for (int i = 0; i < count; ++i) points->insertPointFast(1.0F, 2.0F, 3.0F);
        Cloud cloud;
        cloud.points = points;
        auto stage = StageHarness::of<StatisticalOutlier>();
        stage.give<Cloud>("cloud", cloud);
        stage.fire();
        EXPECT_EQ(stage.out<Cloud>("cloud").size(), 0U) << count;
        EXPECT_EQ(stage.notes().size(), 1U) << count;
    }
}

TEST(StatisticalOutlier, KeepsWhatEveryStagePromises) {
    const auto stage = petal::describe_stage<StatisticalOutlier>("example.statistical_outlier");
    for (const auto& violation :
         petal::testing::contract_violations(stage, petal::testing::calibration_samples()))
        ADD_FAILURE() << violation.rule << ": " << violation.what;
}

}  // namespace
