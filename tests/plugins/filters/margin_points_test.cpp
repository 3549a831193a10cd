// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "filters/margin_points.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <random>

#include "plugins/filters/cloud_samples.hpp"

namespace petal {
namespace {

using ::testing::HasSubstr;
using testing::kept_by;
using testing::Points;
using testing::StageHarness;

constexpr double kDegree = M_PI / 180.0;
/// Half the board's height and width as seen: it lies at 3 m, square to the sensor.
constexpr double kHalfBoard = 2.0;  // deg

struct Ray {
    double azimuth_deg, elevation_deg;
};

/// Rays in a raster over +- `half` deg.
std::vector<Ray> raster(double half, double pitch) {
    std::vector<Ray> rays;
    const int count = static_cast<int>(std::lround(2.0 * half / pitch));
    for (int i = 0; i < count; ++i)
        for (int k = 0; k < count; ++k)
            rays.push_back({pitch * (k + 0.5) - half, pitch * (i + 0.5) - half});
    return rays;
}

/// A point on each ray, at the range that is told for it.
Points measured(const std::vector<Ray>& rays, const std::function<double(const Ray&)>& range) {
    Points points;
    for (const Ray& ray : rays) {
        const double r = range(ray);
        const double azimuth = ray.azimuth_deg * kDegree, elevation = ray.elevation_deg * kDegree;
        points.push_back({static_cast<float>(r * std::cos(elevation) * std::cos(azimuth)),
                          static_cast<float>(r * std::cos(elevation) * std::sin(azimuth)),
                          static_cast<float>(r * std::sin(elevation))});
    }
    return points;
}

/// To the plane x = distance.
double range_ahead(const Ray& ray, double distance) {
    return distance / (std::cos(ray.azimuth_deg * kDegree) * std::cos(ray.elevation_deg * kDegree));
}

/// How far inside the board's outline a ray is, deg; negative outside.
double inside_board(const Ray& ray) {
    return kHalfBoard - std::max(std::abs(ray.azimuth_deg), std::abs(ray.elevation_deg));
}

Points board_before_wall(const std::vector<Ray>& rays, double gap, double noise) {
    std::mt19937_64 engine(5);
    return measured(rays, [&](const Ray& ray) {
        return range_ahead(ray, inside_board(ray) > 0.0 ? 3.0 : 3.0 + gap) +
               static_cast<double>(testing::draw(engine, -1, 1)) * noise * std::sqrt(3.0);
    });
}

StageHarness margins(double step_deg = 0.0) {
    auto stage = StageHarness::of<MarginPoints>("filter.margin_points");
    stage.set("margin_step_deg", step_deg);
    return stage;
}

/// Without noise the margin is known to the point: what lies on the board and has a ray to the wall
/// within half a cell's diagonal and a third of the beam.
TEST(MarginPointsStage, ABoardBeforeAWallHasItsRimAsMargin) {
    const auto rays = raster(4.0, 0.05);
    auto stage = margins(0.3);
    stage.set("beam_deg", 0.1);
    const auto kept = kept_by(stage, board_before_wall(rays, 0.3, 0.0));
    const double reach = 0.3 * std::sqrt(0.5) + 0.1 / 3.0;  // deg
    std::vector<std::uint32_t> expected;
    for (std::uint32_t i = 0; i < rays.size(); ++i) {
        // The nearest ray to the wall is half a pitch outside. 0.245 is not a whole number of
        // pitches, so rounding does not matter.
        const double inside = inside_board(rays[i]);
        if (inside > 0.0 && inside + 0.025 < reach) expected.push_back(i);
    }
    EXPECT_EQ(kept, expected);
}

TEST(MarginPointsStage, NoiseIsMeasuredAndTheMarginDeflated) {
    const auto rays = raster(4.0, 0.04);
    for (const double noise : {0.006, 0.015}) {
        auto stage = margins();
        const auto points = board_before_wall(rays, 0.3, noise);
        const auto kept = kept_by(stage, points);
        std::size_t rim = 0;
        for (const Ray& ray : rays) rim += inside_board(ray) > 0.0 && inside_board(ray) < 0.1;
        EXPECT_GT(kept.size(), rim / 2);  // 58 % of even noise lie within one sigma
        for (const std::uint32_t i : kept) {
            EXPECT_GT(inside_board(rays[i]), 0.0);
            // Half a diagonal of the step, 0.14 deg (it is bounded by the beam), and a third of the
            // beam.
            EXPECT_LT(inside_board(rays[i]), 0.14 * std::sqrt(0.5) + 0.28 / 3.0);
            // One sigma, and what the frontier may be off where a corner leaves it few points.
            EXPECT_LT(std::abs(static_cast<double>(points[i][0]) - 3.0), 1.73 * noise);
        }
        // 7,000 planes: the median is good to a few per cent.
        ASSERT_FALSE(stage.logs().empty());
        const std::string& log = stage.logs()[0];
        const auto at = log.find("noise of ranges ");
        ASSERT_NE(at, std::string::npos) << log;
        EXPECT_NEAR(std::stod(log.substr(at + 16)), noise * 1e3, 0.1 * noise * 1e3);
    }
}

/// Points between board and wall, where a beam of 0.28 deg meets both: spread evenly in range.
TEST(MarginPointsStage, VacantPointsAreNoFrontier) {
    const auto rays = raster(4.0, 0.03);
    std::mt19937_64 engine(9);
    const double noise = 0.01, gap = 0.4;
    const auto points = measured(rays, [&](const Ray& ray) {
        const double share = std::clamp(0.5 - inside_board(ray) / 0.28, 0.0, 1.0);
        return range_ahead(ray, 3.0 + gap * share) +
               static_cast<double>(testing::draw(engine, -1, 1)) * noise * std::sqrt(3.0);
    });
    auto stage = margins();
    const auto kept = kept_by(stage, points);
    const auto is_vacant = [&](const std::array<float, 3>& p) {
        return p[0] > 3.0F + 3.0F * static_cast<float>(noise) &&
               p[0] < 3.0F + static_cast<float>(gap - 3.0 * noise);
    };
    const auto vacant = std::count_if(points.begin(), points.end(), is_vacant);
    std::ptrdiff_t kept_vacant = 0, far = 0;
    for (const std::uint32_t i : kept) {
        kept_vacant += is_vacant(points[i]);
        far += points[i][0] > 3.0F + 0.5F * static_cast<float>(gap);
    }
    EXPECT_GT(kept.size(), 1000U);
    EXPECT_GT(vacant, 3000);
    EXPECT_LT(kept_vacant, vacant / 20);  // where the smear begins they lie on the board's plane
    EXPECT_LT(far, static_cast<std::ptrdiff_t>(kept.size() / 50));
}

TEST(MarginPointsStage, AFloorHasDepthButNoMargin) {
    const auto rays = raster(8.0, 0.05);
    std::mt19937_64 engine(5);
    // Seen at 2 to 18 deg from 0.5 m above: up to 14 m away, and 1 m of depth in a cell.
    const auto floor = measured(rays, [&](const Ray& ray) {
        return 0.5 / std::sin((10.0 + ray.elevation_deg) * kDegree) +
               static_cast<double>(testing::draw(engine, -1, 1)) * 0.02;
    });
    Points turned;  // those rays look ahead: turn them by 10 deg
    for (const auto& p : floor) {
        const double c = std::cos(10.0 * kDegree), s = std::sin(10.0 * kDegree);
        turned.push_back({static_cast<float>(c * p[0] + s * p[2]), p[1],
                          static_cast<float>(c * p[2] - s * p[0])});
    }
    auto stage = margins();
    EXPECT_TRUE(kept_by(stage, turned).empty());
    ASSERT_EQ(stage.notes().size(), 1U);
    EXPECT_THAT(stage.notes()[0].threshold, HasSubstr("range_threshold"));
}

TEST(MarginPointsStage, WhatHasNoDepthHasNoMargin) {
    auto alone = margins();
    EXPECT_TRUE(kept_by(alone, {{3, 0, 0}}).empty());
    auto sphere = margins();
    EXPECT_TRUE(
        kept_by(sphere, measured(raster(3.0, 0.05), [](const Ray&) { return 4.0; })).empty());
    auto origin = margins();
    EXPECT_TRUE(kept_by(origin, Points(100, {0, 0, 0})).empty());
    EXPECT_EQ(origin.notes().size(), 1U);
}

TEST(MarginPointsStage, ATooHighThresholdFindsNothing) {
    const auto points = board_before_wall(raster(3.0, 0.05), 0.15, 0.01);
    auto table = margins(0.15);  // Table I of the letter
    table.set("range_threshold", 0.2);
    EXPECT_TRUE(kept_by(table, points).empty());
    auto derived = margins();
    EXPECT_GT(kept_by(derived, points).size(), 500U);
}

/// In the middle of a rosette the beam dwells: one cell can hold a hundred times the points of the
/// next. A rule that one in so many points lies behind a frontier would lose the edge there.
TEST(MarginPointsStage, AnEdgeIsOneBesideAnyNumberOfPoints) {
    auto rays = raster(3.0, 0.05);
    const std::size_t even = rays.size();
    for (int i = 0; i < 150; ++i)
        for (int k = 0; k < 100; ++k) rays.push_back({1.9 + 0.0005 * k, 0.0005 * i});
    auto stage = margins();
    stage.set("range_threshold", 0.06);
    const auto kept = kept_by(stage, board_before_wall(rays, 0.3, 0.01));
    const auto dwelt = static_cast<std::size_t>(
        kept.end() - std::lower_bound(kept.begin(), kept.end(), static_cast<std::uint32_t>(even)));
    EXPECT_GT(dwelt, (rays.size() - even) / 2);  // 58 % of even noise lie within one sigma
}

/// The letter's cell as it stands gives frontiers too, from fewer cells.
TEST(MarginPointsStage, ACellAloneCanBeJudged) {
    const auto rays = raster(3.0, 0.05);
    auto stage = margins(0.3);
    stage.set("window", 0);
    const auto kept = kept_by(stage, board_before_wall(rays, 0.3, 0.01));
    EXPECT_GT(kept.size(), 100U);
    for (const std::uint32_t i : kept) {
        EXPECT_GT(inside_board(rays[i]), 0.0);
        EXPECT_LT(inside_board(rays[i]), 0.3);
    }
}

TEST(MarginPointsStage, IsAGoodRemover) {
    const auto points = board_before_wall(raster(3.0, 0.05), 0.3, 0.01);
    testing::expect_good_remover([] { return margins(); }, points);
}

}  // namespace
}  // namespace petal
