// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "filters/observation_range.hpp"

#include <gtest/gtest.h>
#include <mrpt/maps/CSimplePointsMap.h>
#include <mrpt/obs/CObservationPointCloud.h>

#include "petal/error.hpp"
#include "petal/testing/stage_harness.hpp"

namespace petal {
namespace {

using testing::StageHarness;

std::size_t left_of(double min_range, double max_range) {
    auto points = mrpt::maps::CSimplePointsMap::Create();
    points->insertPoint(0.0F, 0.0F, 0.0F);
    points->insertPoint(0.0F, 3.0F, 4.0F);     // at 5 m, exactly
    points->insertPoint(-6.0F, 0.0F, 8.0F);    // at 10 m, exactly
    points->insertPoint(1e20F, 1e20F, 1e20F);  // its square overflows a float
    auto cloud = mrpt::obs::CObservationPointCloud::Create();
    cloud->pointcloud = points;
    // On the vehicle, far off: it does not count.
    cloud->sensorPose = mrpt::poses::CPose3D(100.0, 0.0, 0.0);
    StageHarness stage = StageHarness::of<ObservationRange>();
    stage.set("min_range", min_range).set("max_range", max_range);
    stage.give<Observation>("observation", Observation{cloud}).fire();
    const auto& out = stage.out<Observation>("observation");
    return dynamic_cast<const mrpt::obs::CObservationPointCloud&>(*out.observation)
        .pointcloud->size();
}

TEST(ObservationRangeStage, BothEndsBelongToTheRange) {
    EXPECT_EQ(left_of(0.0, 1e6), 3U);
    EXPECT_EQ(left_of(5.0, 10.0), 2U);
    EXPECT_EQ(left_of(5.001, 10.0), 1U);
    EXPECT_EQ(left_of(5.0, 9.999), 1U);
    EXPECT_EQ(left_of(0.0, 0.0), 1U);
}

TEST(ObservationRangeStage, AnEmptyRangeIsRefused) {
    EXPECT_THROW(left_of(2.0, 1.0), Error);
}

}  // namespace
}  // namespace petal
