// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <limits>
#include <memory>
#include <random>
#include <utility>
#include <vector>

#include "petal/calibration/cloud.hpp"
#include "petal/testing/stage_harness.hpp"

namespace petal::testing {

using Points = std::vector<std::array<float, 3>>;

/// The k-th point has intensity k.
inline Cloud cloud_of(const Points& points) {
    auto map = std::make_shared<mrpt::maps::CPointsMapXYZI>();
    for (const auto& p : points) {
        map->insertPointFast(p[0], p[1], p[2]);
        map->setPointIntensity(map->size() - 1, static_cast<float>(map->size() - 1));
    }
    map->mark_as_modified();
    Cloud cloud;
    cloud.points = std::move(map);
    return cloud;
}

/// In [low, high), the same with every standard library.
inline float draw(std::mt19937_64& engine, float low, float high) {
    return low + (high - low) * static_cast<float>(engine() >> 40U) * 0x1.0p-24F;
}

/// Which points of its input (one without scene_index) a stage lets through.
inline std::vector<std::uint32_t> kept_by(StageHarness& stage, const Points& points) {
    stage.give<Cloud>("cloud", cloud_of(points));
    stage.fire();
    return stage.out<Cloud>("cloud").scene_index;
}

/// What every remover of outliers keeps to, tried with points of which it keeps some and drops
/// some: order, intensity, label, pose, scene_index; NaN and empty clouds; any number of threads.
/// `make` makes the stage.
template <class Make>
void expect_good_remover(const Make& make, const Points& points) {
    constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
    StageHarness plain = make();
    const auto kept = kept_by(plain, points);
    EXPECT_TRUE(plain.notes().empty());
    ASSERT_GT(kept.size(), 0U);
    ASSERT_LT(kept.size(), points.size());

    Cloud rich = cloud_of(points);
    rich.sensor_label = "MID70";
    rich.sensor_pose = mrpt::poses::CPose3D(1.0, 2.0, 3.0, 0.1, 0.2, 0.3);
    rich.parts = {{0, mrpt::Clock::fromDouble(1.7e9)}};
    for (std::uint32_t i = 0; i < points.size(); ++i) rich.scene_index.push_back(1000 + 3 * i);
    for (const int threads : {1, 2, 4}) {
        StageHarness stage = make();
        stage.threads(threads);
        stage.give<Cloud>("cloud", rich);
        stage.fire();
        const auto& out = stage.out<Cloud>("cloud");
        ASSERT_EQ(out.size(), kept.size()) << threads;
        ASSERT_EQ(out.scene_index.size(), kept.size());
        for (std::size_t k = 0; k < kept.size(); ++k) {
            ASSERT_EQ(out.scene_index[k], 1000 + 3 * kept[k]);
            ASSERT_EQ(out.points->getPointIntensity(k), static_cast<float>(kept[k]));
            ASSERT_EQ(out.points->getPointsBufferRef_z()[k], points[kept[k]][2]);
        }
        EXPECT_EQ(out.sensor_label, "MID70");
        EXPECT_EQ(out.sensor_pose, rich.sensor_pose);
        EXPECT_TRUE(out.parts.empty());
    }

    // Three points that are not finite, in front of the others: they go, and nothing else changes.
    Points broken = {{kNaN, 0.0F, 0.0F},
                     {0.0F, std::numeric_limits<float>::infinity(), 0.0F},
                     {1.0F, 1.0F, kNaN}};
    broken.insert(broken.end(), points.begin(), points.end());
    StageHarness with_nan = make();
    auto moved = kept_by(with_nan, broken);
    for (std::uint32_t& i : moved) i -= 3;
    EXPECT_EQ(moved, kept);
    ASSERT_EQ(with_nan.notes().size(), 1U);
    EXPECT_THAT(
        with_nan.notes()[0].nearest_miss,
        ::testing::HasSubstr("3 of " + std::to_string(broken.size()) + " points are not finite"));

    StageHarness empty = make();
    EXPECT_TRUE(kept_by(empty, {}).empty());
    ASSERT_EQ(empty.notes().size(), 1U);
    EXPECT_EQ(empty.notes()[0].nearest_miss, "the cloud is empty");

    StageHarness lost = make();
    EXPECT_TRUE(kept_by(lost, {{kNaN, kNaN, kNaN}}).empty());
    EXPECT_EQ(lost.notes().size(), 1U);
}

}  // namespace petal::testing
