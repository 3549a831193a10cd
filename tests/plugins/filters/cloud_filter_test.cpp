// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "filters/detail/cloud_filter.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <mrpt/maps/CColouredPointsMap.h>
#include <mrpt/maps/CPointsMapXYZI.h>
#include <mrpt/maps/CSimplePointsMap.h>
#include <mrpt/maps/CWeightedPointsMap.h>
#include <mrpt/obs/CActionCollection.h>
#include <mrpt/obs/CObservation2DRangeScan.h>
#include <mrpt/obs/CObservationIMU.h>
#include <mrpt/obs/CObservationPointCloud.h>

#include <limits>

#include "filters/observation_range.hpp"
#include "petal/testing/stage_harness.hpp"
#include "rawlog_objects.hpp"

namespace petal {
namespace {

using namespace mrpt::obs;
using ::testing::HasSubstr;
using testing::object_bytes;
using testing::StageHarness;

CObservationPointCloud::Ptr cloud_of(mrpt::maps::CPointsMap::Ptr points) {
    auto observation = CObservationPointCloud::Create();
    observation->sensorLabel = "LIDAR";
    observation->timestamp = mrpt::Clock::fromDouble(1.7e9);
    observation->sensorPose = mrpt::poses::CPose3D(1.0, 2.0, 3.0, 0.1, 0.2, 0.3);
    observation->pointcloud = std::move(points);
    return observation;
}

const mrpt::maps::CPointsMap& points_of(const Observation& observation) {
    return *dynamic_cast<const CObservationPointCloud&>(*observation.observation).pointcloud;
}

/// Three points at 1, 10 and 2 m, of which the middle one goes.
template <class Map>
std::shared_ptr<Map> three_points() {
    auto points = Map::Create();
    for (const float x : {1.0F, 10.0F, 2.0F}) points->insertPoint(x, 0.0F, 0.0F);
    points->insertionOptions.minDistBetweenLaserPoints = 0.25F;  // stored with the map
    return points;
}

StageHarness below_five_metres() {
    StageHarness stage = StageHarness::of<ObservationRange>();
    stage.set("max_range", 5.0);
    return stage;
}

template <class Map>
const Map& filtered(StageHarness& stage, const std::shared_ptr<Map>& points) {
    stage.give<Observation>("observation", Observation{cloud_of(points)});
    stage.fire();
    return dynamic_cast<const Map&>(points_of(stage.out<Observation>("observation")));
}

TEST(CloudFilterStages, TheClassOfTheMapAndAllChannelsStay) {
    auto lit = three_points<mrpt::maps::CPointsMapXYZI>();
    for (std::size_t i = 0; i < 3; ++i) lit->setPointIntensity(i, 0.25F * static_cast<float>(i));
    StageHarness intensity = below_five_metres();
    const auto& some = filtered(intensity, lit);
    ASSERT_EQ(some.size(), 2U);
    EXPECT_EQ(some.getPointsBufferRef_x()[1], 2.0F);
    EXPECT_EQ(some.getPointIntensity(0), 0.0F);
    EXPECT_EQ(some.getPointIntensity(1), 0.5F);
    EXPECT_EQ(some.insertionOptions.minDistBetweenLaserPoints, 0.25F);

    auto coloured = three_points<mrpt::maps::CColouredPointsMap>();
    for (std::size_t i = 0; i < 3; ++i)
        coloured->setPointColor_fast(i, 0.25F * static_cast<float>(i), 0.5F, 1.0F);
    StageHarness colour = below_five_metres();
    float r = 0, g = 0, b = 0;
    filtered(colour, coloured).getPointColor_fast(1, r, g, b);
    EXPECT_EQ(r, 0.5F);
    EXPECT_EQ(b, 1.0F);

    auto weighted = three_points<mrpt::maps::CWeightedPointsMap>();
    for (unsigned i = 0; i < 3; ++i) weighted->setPointWeight(i, i + 1);
    StageHarness weight = below_five_metres();
    EXPECT_EQ(filtered(weight, weighted).getPointWeight(1), 3U);

    StageHarness simple = below_five_metres();
    EXPECT_EQ(filtered(simple, three_points<mrpt::maps::CSimplePointsMap>()).size(), 2U);
}

TEST(CloudFilterStages, TheInputStaysAndTheRestIsKept) {
    const auto points = three_points<mrpt::maps::CPointsMapXYZI>();
    const auto before = cloud_of(points);
    const std::string bytes = object_bytes(*before);
    Observation in{before};
    in.place.before = {CActionCollection::Create()};
    in.place.in_frame = true;
    StageHarness stage = below_five_metres();
    stage.give<Observation>("observation", in);
    stage.fire();
    EXPECT_EQ(object_bytes(*before), bytes);
    const auto& out = stage.out<Observation>("observation");
    EXPECT_EQ(out.place.before, in.place.before);
    EXPECT_TRUE(out.place.in_frame);
    // But for its points it is the same: put them back, and every byte is.
    auto again = CObservationPointCloud::Create(
        dynamic_cast<const CObservationPointCloud&>(*out.observation));
    again->pointcloud = points;
    EXPECT_EQ(object_bytes(*again), bytes);
}

TEST(CloudFilterStages, WhatLosesNothingIsTheVerySameObject) {
    auto empty = cloud_of(nullptr);
    auto near = mrpt::maps::CSimplePointsMap::Create();
    near->insertPoint(1.0F, 0.0F, 0.0F);
    StageHarness stage = below_five_metres();
    const std::vector<CObservation::Ptr> all = {CObservationIMU::Create(), empty, cloud_of(near)};
    for (const auto& each : all) stage.give<Observation>("observation", Observation{each});
    stage.fire();
    const auto out = stage.all<Observation>("observation");
    ASSERT_EQ(out.size(), all.size());
    for (std::size_t i = 0; i < all.size(); ++i) EXPECT_EQ(out[i]->observation, all[i]);
    EXPECT_TRUE(stage.notes().empty());
    EXPECT_THAT(stage.logs().back(), HasSubstr("1 of 1 points stay"));
    EXPECT_THAT(stage.logs().back(), HasSubstr("2 other observations passed"));
}

TEST(CloudFilterStages, OnlyTheLabelsThatAreNamedAreFiltered) {
    StageHarness stage = below_five_metres();
    stage.set("labels", Value(std::vector<std::string>{"LEFT*"}));
    const auto cloud = cloud_of(three_points<mrpt::maps::CSimplePointsMap>());
    const auto left = cloud_of(three_points<mrpt::maps::CSimplePointsMap>());
    left->sensorLabel = "LEFT_LIDAR";
    stage.give<Observation>("observation", Observation{cloud});
    stage.give<Observation>("observation", Observation{left});
    stage.fire();
    const auto out = stage.all<Observation>("observation");
    EXPECT_EQ(points_of(*out[0]).size(), 3U);
    EXPECT_EQ(points_of(*out[1]).size(), 2U);
}

TEST(CloudFilterStages, PointsThatAreNotFiniteGoAndAreTold) {
    constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
    constexpr float kInf = std::numeric_limits<float>::infinity();
    auto points = mrpt::maps::CPointsMapXYZI::Create();
    points->insertPointFast(kNaN, 1.0F, 1.0F);
    points->insertPointFast(1.0F, kInf, 1.0F);
    points->insertPointFast(1.0F, 1.0F, 1.0F);
    StageHarness stage = StageHarness::of<ObservationRange>();
    EXPECT_EQ(filtered(stage, points).size(), 1U);
    EXPECT_THAT(stage.logs().back(), HasSubstr("1 of 3 points stay (2 were not finite)"));
}

TEST(CloudFilterStages, WhatIsNotFilteredAndWhatIsEmptyIsNoted) {
    StageHarness none = below_five_metres();
    none.give<Observation>("observation", Observation{CObservationIMU::Create()});
    none.fire();
    ASSERT_EQ(none.notes().size(), 1U);
    EXPECT_EQ(none.notes()[0].looked_for, "point clouds");

    StageHarness flat = below_five_metres();
    auto scan = CObservation2DRangeScan::Create();
    scan->sensorLabel = "SICK";
    for (int i = 0; i < 2; ++i) flat.give<Observation>("observation", Observation{scan});
    flat.fire();
    ASSERT_EQ(flat.notes().size(), 1U);
    EXPECT_THAT(flat.notes()[0].nearest_miss, HasSubstr("2 observations of 'SICK'"));

    StageHarness all = StageHarness::of<ObservationRange>();
    all.set("min_range", 50.0);
    EXPECT_EQ(filtered(all, three_points<mrpt::maps::CPointsMapXYZI>()).size(), 0U);
    ASSERT_EQ(all.notes().size(), 1U);
    EXPECT_THAT(all.notes()[0].nearest_miss, HasSubstr("none of 3"));
}

}  // namespace
}  // namespace petal
