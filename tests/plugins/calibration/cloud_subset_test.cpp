// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "petal/calibration/cloud_subset.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "plugins/filters/cloud_samples.hpp"

namespace petal {
namespace {

using ::testing::ElementsAre;

constexpr float kInfinite = std::numeric_limits<float>::infinity();

TEST(CloudSubset, PointsKeepWhatTheyBring) {
    Cloud cloud = testing::cloud_of({{1, 2, 3}, {4, 5, 6}, {7, 8, 9}});
    cloud.sensor_label = "FRONT";
    cloud.sensor_pose = mrpt::poses::CPose3D(1.0, 2.0, 3.0, 0.1, 0.2, 0.3);
    cloud.parts = {{0, mrpt::Clock::fromDouble(1.7e9)}};
    const Cloud taken = subset(cloud, {0, 2});
    EXPECT_THAT(taken.points->getPointsBufferRef_x(), ElementsAre(1, 7));
    EXPECT_THAT(taken.points->getPointsBufferRef_y(), ElementsAre(2, 8));
    EXPECT_THAT(taken.points->getPointsBufferRef_z(), ElementsAre(3, 9));
    EXPECT_THAT(taken.points->getPointsBufferRef_intensity(), ElementsAre(0, 2));
    EXPECT_EQ(taken.sensor_label, "FRONT");
    EXPECT_EQ(taken.sensor_pose, cloud.sensor_pose);
    EXPECT_TRUE(taken.parts.empty());
    EXPECT_EQ(cloud.size(), 3U);
}

TEST(CloudSubset, SceneIndicesAreComposed) {
    const Cloud cloud = testing::cloud_of({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}});
    const Cloud once = subset(cloud, {0, 2, 3});
    EXPECT_THAT(once.scene_index, ElementsAre(0, 2, 3));
    EXPECT_THAT(subset(once, {1, 2}).scene_index, ElementsAre(2, 3));
    EXPECT_EQ(subset(once, {}).size(), 0U);
}

TEST(CloudSubset, FiniteMeansAllThreeCoordinates) {
    const Cloud cloud = testing::cloud_of({{kInfinite, 0, 0},
                                           {0, 0, 0},
                                           {0, -kInfinite, 0},
                                           {1e30F, 0, 0},
                                           {0, 0, std::numeric_limits<float>::quiet_NaN()}});
    EXPECT_THAT(finite_points(cloud), ElementsAre(1, 3));
}

}  // namespace
}  // namespace petal
