// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "filters/observation_voxel.hpp"

#include <gtest/gtest.h>
#include <mrpt/maps/CPointsMapXYZI.h>
#include <mrpt/obs/CObservationPointCloud.h>

#include <cmath>
#include <random>
#include <set>
#include <tuple>

#include "petal/testing/stage_harness.hpp"

namespace petal {
namespace {

using testing::StageHarness;

mrpt::maps::CPointsMap::Ptr thinned(const mrpt::maps::CPointsMap::Ptr& points, double size) {
    auto cloud = mrpt::obs::CObservationPointCloud::Create();
    cloud->pointcloud = points;
    StageHarness stage = StageHarness::of<ObservationVoxel>();
    stage.set("size", size);
    stage.give<Observation>("observation", Observation{cloud}).fire();
    const auto& out = stage.out<Observation>("observation");
    return dynamic_cast<const mrpt::obs::CObservationPointCloud&>(*out.observation).pointcloud;
}

TEST(ObservationVoxelStage, TheFirstPointOfACellStaysAsItIs) {
    auto points = mrpt::maps::CPointsMapXYZI::Create();
    const float xs[] = {0.2F, 0.8F, 1.2F, -0.2F, -0.0F};
    for (std::size_t i = 0; i < 5; ++i) {
        points->insertPoint(xs[i], 0.5F, 0.5F);
        points->setPointIntensity(i, 0.1F * static_cast<float>(i));
    }
    const auto left = std::dynamic_pointer_cast<mrpt::maps::CPointsMapXYZI>(thinned(points, 1.0));
    ASSERT_TRUE(left);
    // 0.2, 0.8 and -0 share a cell; -0.2 lies in the next one: no double cell about zero.
    ASSERT_EQ(left->size(), 3U);
    EXPECT_EQ(left->getPointsBufferRef_x()[0], 0.2F);
    EXPECT_EQ(left->getPointsBufferRef_x()[1], 1.2F);
    EXPECT_EQ(left->getPointsBufferRef_x()[2], -0.2F);
    EXPECT_EQ(left->getPointIntensity(1), points->getPointIntensity(2));
}

TEST(ObservationVoxelStage, AsManyPointsStayAsThereAreCells) {
    auto points = mrpt::maps::CPointsMapXYZI::Create();
    std::mt19937 rng(3);
    std::uniform_real_distribution<float> place(-2.0F, 2.0F);
    std::set<std::tuple<int, int, int>> cells;
    for (int i = 0; i < 5000; ++i) {
        const float x = place(rng), y = place(rng), z = place(rng);
        points->insertPoint(x, y, z);
        const auto cell = [](float v) { return static_cast<int>(std::floor(v / 0.5)); };
        cells.insert({cell(x), cell(y), cell(z)});
    }
    EXPECT_EQ(thinned(points, 0.5)->size(), cells.size());
}

TEST(ObservationVoxelStage, FarPointsHaveCellsOfTheirOwn) {
    auto points = mrpt::maps::CPointsMapXYZI::Create();
    for (const float x : {3e37F, 1e38F, -1e38F}) points->insertPoint(x, 0.0F, 0.0F);
    EXPECT_EQ(thinned(points, 0.001)->size(), 3U);
}

}  // namespace
}  // namespace petal
