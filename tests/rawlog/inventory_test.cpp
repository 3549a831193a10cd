// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "petal/rawlog/inventory.hpp"

#include <gmock/gmock.h>
#include <mrpt/obs/CActionCollection.h>
#include <mrpt/obs/CActionRobotMovement2D.h>
#include <mrpt/obs/CObservationComment.h>
#include <mrpt/obs/CObservationRotatingScan.h>
#include <mrpt/obs/CSensoryFrame.h>

#include <limits>

#include "petal/error.hpp"
#include "rawlog_bytes.hpp"

namespace petal::testing {
namespace {

using namespace mrpt::obs;
using ::testing::HasSubstr;

RawlogInventory inventory_of(const Objects& objects) {
    RawlogInventory inventory;
    for (const auto& object : objects) inventory.add(*object, [](CObservation&) {});
    return inventory;
}

const SensorInventory& only(const RawlogInventory& inventory) {
    EXPECT_EQ(inventory.sensors().size(), 1U);
    return inventory.sensors().begin()->second;
}

TEST(Inventory, RatesGapsAndStampsThatRunBackwards) {
    Objects objects;
    for (const double stamp : {0.0, 0.1, 0.2, 0.3, 1.3, 1.4, 1.35, 1.45})
        objects.push_back(cloud("LIDAR", stamp));
    auto unknown = cloud("LIDAR", 0.0);
    unknown->timestamp = {};
    objects.push_back(unknown);
    const RawlogInventory inventory = inventory_of(objects);
    const StampInventory& stamps = only(inventory).stamps;
    EXPECT_NEAR(stamps.rate(), 10.0, 1e-4);  // stamps have ticks of 100 ns
    EXPECT_EQ(stamps.gaps().first, 1U);
    EXPECT_NEAR(stamps.gaps().second, 1.0, 1e-6);
    EXPECT_EQ(stamps.backward(), 1U);
    EXPECT_EQ(stamps.unknown(), 1U);
    EXPECT_TRUE(stamps.unsteady());  // one interval of six
    EXPECT_EQ(only(inventory).messages, 9U);
    EXPECT_EQ(inventory.time()->first, at(0.0));
    EXPECT_EQ(inventory.time()->second, at(1.45));
}

TEST(Inventory, OneStampHasNoRate) {
    const RawlogInventory inventory = inventory_of({cloud("LIDAR", 3.0)});
    EXPECT_EQ(only(inventory).stamps.rate(), 0.0);
    EXPECT_FALSE(only(inventory).stamps.unsteady());
    EXPECT_EQ(inventory_of({}).time(), std::nullopt);
    EXPECT_EQ(inventory_of({}).layout(), RawlogInventory::Layout::empty);
}

TEST(Inventory, PointsRangesAndIntensity) {
    auto odd = cloud("LIDAR", 0.2, 3);  // (2, 0, 0), (2, 0, 0.5), (2, 0, 1)
    auto& map = *odd->pointcloud;
    map.insertPoint(0.0F, 0.0F, 0.0F);
    map.insertPoint(std::numeric_limits<float>::quiet_NaN(), 0.0F, 0.0F);
    const RawlogInventory inventory =
        inventory_of({cloud("LIDAR", 0.0, 1), cloud("LIDAR", 0.1, 2), odd});
    const PointsInventory& points = only(inventory).points.value();
    EXPECT_EQ(points.total, 8U);
    EXPECT_EQ(points.per_message, (std::vector<double>{1, 2, 5}));
    EXPECT_EQ(points.at_origin, 1U);
    EXPECT_EQ(points.not_finite, 1U);
    EXPECT_DOUBLE_EQ(points.range.min, 2.0);
    EXPECT_NEAR(points.range.max, std::sqrt(5.0), 1e-6);  // floats
    EXPECT_TRUE(points.has_intensity);
    EXPECT_EQ(points.intensity.max, 0.25);
}

TEST(Inventory, ImagesAndTheirIntrinsics) {
    auto small = image("CAMERA", 0.1);
    small->image.resize(30, 20, mrpt::img::CH_GRAY);
    auto none = image("CAMERA", 0.2);
    none->image = mrpt::img::CImage();
    const RawlogInventory inventory = inventory_of({image("CAMERA", 0.0), small, none});
    const ImagesInventory& images = only(inventory).images.at("");
    EXPECT_EQ(images.count, 3U);
    EXPECT_EQ(images.width, 60);
    EXPECT_EQ(images.channels, 1);
    EXPECT_EQ(images.other_sizes, 1U);
    EXPECT_EQ(images.size_mismatches, 1U);
    EXPECT_EQ(images.empty, 1U);
    EXPECT_EQ(images.camera.fx(), 50.0);
}

TEST(Inventory, LayoutsActionsAndComments) {
    auto frame = CSensoryFrame::Create();
    frame->insert(cloud("LIDAR", 0.0));
    frame->insert(image("CAMERA", 0.0));
    auto actions = CActionCollection::Create();
    actions->insert(*CActionRobotMovement2D::Create());
    auto comment = CObservationComment::Create();
    comment->timestamp = at(1e6);
    EXPECT_EQ(inventory_of({frame, actions}).layout(), RawlogInventory::Layout::sensory_frames);
    EXPECT_EQ(inventory_of({comment}).layout(), RawlogInventory::Layout::observations);
    const RawlogInventory mixed = inventory_of({actions, frame, comment});
    EXPECT_EQ(mixed.layout(), RawlogInventory::Layout::mixed);
    EXPECT_EQ(mixed.observations(), 3U);
    EXPECT_EQ(mixed.actions().at("mrpt::obs::CActionRobotMovement2D"), 1U);
    EXPECT_EQ(mixed.time()->second, at(0.0)) << "a comment is no measurement";
}

TEST(Inventory, WhatCannotBeLoadedIsCountedAndSaid) {
    RawlogInventory inventory;
    auto outside = image("CAMERA", 0.0);
    outside->image.setExternalStorage("none.png");
    for (int i = 0; i < 2; ++i)
        inventory.add(*outside, [&](CObservation&) { throw Error("none.png is not there"); });
    EXPECT_EQ(only(inventory).external, 2U);
    EXPECT_EQ(only(inventory).unloaded, 2U);
    EXPECT_EQ(only(inventory).first_unloaded, "none.png is not there");
}

TEST(Inventory, ARotatingScanWithRowsHasRangesAndNoCloud) {
    auto scan = CObservationRotatingScan::Create();
    scan->rowCount = 2;
    scan->columnCount = 3;
    scan->rangeResolution = 0.5;
    scan->rangeImage.setZero(2, 3);
    scan->rangeImage(0, 1) = 4;
    scan->rangeImage(1, 2) = 9;
    const RawlogInventory inventory = inventory_of({scan});
    const PointsInventory& points = only(inventory).points.value();
    EXPECT_EQ(points.total, 2U);
    EXPECT_EQ(points.range.min, 2.0);
    EXPECT_EQ(points.range.max, 4.5);
    EXPECT_THAT(points.no_cloud, HasSubstr("2 rows"));
}

}  // namespace
}  // namespace petal::testing
