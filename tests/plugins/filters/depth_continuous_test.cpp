// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "filters/depth_continuous.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "petal/error.hpp"
#include "plugins/filters/cloud_samples.hpp"

namespace petal {
namespace {

using testing::kept_by;
using testing::Points;
using testing::StageHarness;

StageHarness joins() {
    auto stage = StageHarness::of<DepthContinuous>("filter.depth_continuous");
    stage.set("voxel_size", 1.0);
    return stage;
}

/// In one voxel of 1 m, on a grid of 2 cm: a floor, and a wall that starts `gap` above and behind
/// it and leans by `lean_deg` from the upright. The floor's points come first.
Points floor_and_wall(float gap, double lean_deg, std::size_t& floor_points) {
    const double lean = lean_deg / 180.0 * 3.14159265358979323846;
    Points points;
    for (int i = 0; i < 20; ++i)
        for (int j = 0; j < 40; ++j)
            points.push_back({4.61F - 0.02F * static_cast<float>(i) - gap,
                              1.1F + 0.02F * static_cast<float>(j), 2.1F});
    floor_points = points.size();
    for (int i = 0; i < 20; ++i)
        for (int j = 0; j < 40; ++j) {
            const float up = 0.02F * static_cast<float>(i) + 0.01F + gap;
            points.push_back({4.62F + up * static_cast<float>(std::sin(lean)),
                              1.1F + 0.02F * static_cast<float>(j),
                              2.1F + up * static_cast<float>(std::cos(lean))});
        }
    return points;
}

TEST(DepthContinuousStage, OnlyThePointsNearTheLineStay) {
    std::size_t floor = 0;
    const Points points = floor_and_wall(0.0F, 0.0, floor);
    auto stage = joins();
    const auto kept = kept_by(stage, points);
    // The line is x = 4.62, z = 2.1. Rows of both lie 1, 3, 5, ... cm from it; the nearest row of
    // each may count to either plane (3 cm thick), so the fitted line is good to a few mm: rows at
    // 1 and 3 cm stay, those from 7 cm on go.
    std::size_t near = 0;
    for (const std::uint32_t i : kept) {
        const double off = std::hypot(points[i][0] - 4.62F, points[i][2] - 2.1F);
        EXPECT_LT(off, 0.065);
        if (off < 0.035) ++near;
    }
    EXPECT_EQ(near, 4U * 40U);
    EXPECT_TRUE(stage.notes().empty());
}

TEST(DepthContinuousStage, AJumpInDepthIsNoJoin) {
    std::size_t floor = 0;
    auto stage = joins();
    EXPECT_TRUE(kept_by(stage, floor_and_wall(0.1F, 0.0, floor)).empty());
    ASSERT_EQ(stage.notes().size(), 1U);
    EXPECT_EQ(stage.notes()[0].looked_for, "lines where two planes join");

    // A board before a wall: parallel planes, nothing in between.
    Points parallel;
    for (int i = 0; i < 40; ++i)
        for (int j = 0; j < 40; ++j)
            parallel.push_back({i < 20 ? 4.3F : 4.6F, 1.1F + 0.02F * static_cast<float>(j),
                                2.1F + 0.02F * static_cast<float>(i)});
    auto board = joins();
    EXPECT_TRUE(kept_by(board, parallel).empty());
}

TEST(DepthContinuousStage, NoiseAndVacantPointsMakeNoPlane) {
    // A board in front of a wall with a noise of up to 6 cm, twice the thickness of a plane, and a
    // curtain of vacant points between them, one in 25 of all: each could hold planes of its own.
    std::mt19937_64 engine(5);
    Points points;
    for (int i = 0; i < 12500; ++i) {
        const float across = testing::draw(engine, 0.0F, 0.7F);
        const bool vacant = i % 25 == 0;
        // Of three draws the sum is bell-shaped: sigma 2 cm.
        float noise = 0.0F;
        for (int k = 0; k < 3; ++k) noise += testing::draw(engine, -0.02F, 0.02F);
        const float depth =
            vacant ? testing::draw(engine, 0.1F, 0.5F) : (across < 0.35F ? 0.1F : 0.5F) + noise;
        points.push_back({4.1F + depth, 1.1F + (vacant ? 0.35F : across),
                          2.1F + testing::draw(engine, 0.0F, 0.5F)});
    }
    auto stage = joins();
    EXPECT_TRUE(kept_by(stage, points).empty());
}

TEST(DepthContinuousStage, WhereOnlyPartOfTheLineIsSharedOnlyThatPartStays) {
    std::size_t floor = 0;
    Points points = floor_and_wall(0.0F, 0.0, floor);
    // The wall ends half way along the line, at y = 1.5.
    points.erase(std::remove_if(points.begin() + static_cast<std::ptrdiff_t>(floor), points.end(),
                                [](const auto& p) { return p[1] > 1.495F; }),
                 points.end());
    auto stage = joins();
    const auto kept = kept_by(stage, points);
    float last = 0.0F;
    for (const std::uint32_t i : kept) last = std::max(last, points[i][1]);
    EXPECT_NEAR(last, 1.48F + 0.05F, 0.021F);  // max_gap beyond the wall, on a grid of 2 cm
}

TEST(DepthContinuousStage, TheAngleLiesBetweenTheLimits) {
    const auto kept = [](double lean_deg, double min_deg, double max_deg) {
        std::size_t floor = 0;
        auto stage = joins();
        stage.set("min_angle_deg", min_deg).set("max_angle_deg", max_deg);
        return kept_by(stage, floor_and_wall(0.0F, lean_deg, floor)).size();
    };
    // Leaning back by 40 deg, the planes are at 50 deg (fitted to about 1 deg: 3 cm of 40).
    EXPECT_GT(kept(40.0, 45.0, 55.0), 0U);
    EXPECT_EQ(kept(40.0, 55.0, 90.0), 0U);
    EXPECT_EQ(kept(40.0, 0.0, 45.0), 0U);
    EXPECT_GT(kept(0.0, 80.0, 90.0), 0U);
    auto wrong = joins();
    wrong.set("min_angle_deg", 60.0).set("max_angle_deg", 30.0);
    EXPECT_THROW(wrong.fire(), Error);
}

TEST(DepthContinuousStage, TooFewPointsAreNoPlane) {
    std::size_t floor = 0;
    const Points points = floor_and_wall(0.0F, 0.0, floor);
    auto stage = joins();
    stage.set("min_points", 801);
    EXPECT_TRUE(kept_by(stage, points).empty());
}

TEST(DepthContinuousStage, DoesWhatAllRemoversDo) {
    // A row of voxels with noise, so that what is drawn matters.
    std::mt19937_64 engine(11);
    Points points;
    std::size_t floor = 0;
    for (int voxel = 0; voxel < 20; ++voxel)
        for (const auto& p : floor_and_wall(0.0F, 10.0, floor))
            points.push_back({p[0] + testing::draw(engine, -0.02F, 0.02F),
                              p[1] + static_cast<float>(voxel),
                              p[2] + testing::draw(engine, -0.02F, 0.02F)});
    testing::expect_good_remover(joins, points);
}

}  // namespace
}  // namespace petal
