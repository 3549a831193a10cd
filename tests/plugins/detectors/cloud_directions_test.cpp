// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "detectors/detail/cloud_directions.hpp"

#include <gtest/gtest.h>
#include <mrpt/maps/CPointsMapXYZI.h>

#include <cmath>
#include <limits>
#include <vector>

#include "detectors/detail/lidar_template_rays.hpp"
#include "noise.hpp"
#include "petal/calibration/angles.hpp"
#include "petal/calibration/plane_fit.hpp"

namespace petal {
namespace {

using testing::normal;

Cloud cloud_of(const std::vector<Eigen::Vector3f>& points) {
    auto map = mrpt::maps::CPointsMapXYZI::Create();
    for (const Eigen::Vector3f& p : points) map->insertPoint(p.x(), p.y(), p.z());
    Cloud cloud;
    cloud.points = map;
    return cloud;
}

std::vector<Eigen::Vector3f> points_all_around(std::size_t count) {
    Rng rng(2);
    std::vector<Eigen::Vector3f> points;
    while (points.size() < count) {
        const double x = normal(rng, 2.0), y = normal(rng, 2.0), z = normal(rng, 2.0);
        points.push_back(Eigen::Vector3d(x, y, z).cast<float>());
    }
    return points;
}

// Along axes, where two or three faces of the cube meet, and elsewhere.
TEST(CloudDirections, NoPointWithinTheAngleIsLeftOut) {
    std::vector<Eigen::Vector3f> points = points_all_around(20000);
    for (const float a : {-1.0F, 0.0F, 1.0F})
        for (const float b : {-1.0F, 0.0F, 1.0F})
            for (const float c : {-1.0F, 1.0F}) {
                points.emplace_back(a, b, c);
                points.emplace_back(a, c, b);
                points.emplace_back(c, a, b);
            }
    const Cloud cloud = cloud_of(points);
    const CloudDirections directions(cloud);
    for (const Eigen::Vector3d& axis :
         {Eigen::Vector3d(1, 0, 0), Eigen::Vector3d(0, -1, 0), Eigen::Vector3d(1, 1, 1),
          Eigen::Vector3d(-1, 0, 1), Eigen::Vector3d(0.3, -0.2, -0.9)})
        for (const double angle : {0.0, 0.1, 1.0, kPi}) {
            std::vector<int> visits(points.size(), 0);
            directions.around(axis.normalized(), angle, [&](const auto* begin, const auto* end) {
                for (const auto* i = begin; i != end; ++i) ++visits[*i];
            });
            std::size_t others = 0;
            for (std::size_t i = 0; i < points.size(); ++i) {
                ASSERT_LE(visits[i], 1);
                const double off =
                    std::acos(std::min(1.0, axis.normalized().dot(points[i].cast<double>()) /
                                                points[i].cast<double>().norm()));
                if (off <= angle) {
                    ASSERT_EQ(visits[i], 1) << points[i].transpose();
                }
                // Tiles are less than 5 deg wide, from corner to corner.
                others += visits[i] == 1 && off > angle + 5.0 / kDegrees;
            }
            EXPECT_EQ(others, 0U);
        }
}

TEST(CloudDirections, WhatHasNoDirectionIsLeftOut) {
    const float nan = std::nanf(""), infinite = std::numeric_limits<float>::infinity();
    const Cloud cloud = cloud_of({{0, 0, 0},
                                  {nan, 1, 1},
                                  {1, nan, 1},
                                  {1, 1, nan},
                                  {infinite, 1, 1},
                                  {1, 1, -infinite},
                                  {1, 2, 3}});
    std::vector<std::uint32_t> visited;
    CloudDirections(cloud).around(
        Eigen::Vector3d::UnitX(), kPi,
        [&](const auto* begin, const auto* end) { visited.insert(visited.end(), begin, end); });
    EXPECT_EQ(visited, std::vector<std::uint32_t>{6});
}

TEST(CloudDirections, AnEmptyCloudHasNone) {
    const Cloud cloud = cloud_of({});
    CloudDirections(cloud).around(Eigen::Vector3d::UnitX(), kPi,
                                  [](const auto*, const auto*) { FAIL(); });
}

// 40000 of 200000 rays towards a wall cross a circle on it: all, or evenly some of them.
TEST(GatherRays, TakesAllThatCrossOrEvenlyAsManyAsAreAskedFor) {
    Rng rng(3);
    std::vector<Eigen::Vector3f> points;
    std::size_t within = 0;
    for (int i = 0; i < 200000; ++i) {
        const double y = normal(rng, 0.5), z = normal(rng, 0.5);
        points.push_back(Eigen::Vector3d(3.0, y, z).cast<float>());
        within += std::hypot(y, z) <= 0.334;
    }
    const Cloud cloud = cloud_of(points);
    const CloudDirections directions(cloud);
    const Eigen::Isometry3d plane = plane_frame(-Eigen::Vector3d::UnitX(), {3.0, 0.0, 0.0});
    const RayBundle all = gather_rays(directions, plane, 0.334);
    EXPECT_NEAR(static_cast<double>(all.rays.size()), static_cast<double>(within), 5.0);
    EXPECT_EQ(all.crossed, all.rays.size());
    for (const std::size_t most : {24000UL, 2000UL}) {
        const RayBundle some = gather_rays(directions, plane, 0.334, most);
        EXPECT_LE(some.rays.size(), most);
        EXPECT_GE(some.rays.size(), most / 2);
        // Counted from a sample of at least `most`/2: 3 sigma of that.
        EXPECT_NEAR(
            static_cast<double>(some.crossed), static_cast<double>(within),
            3.0 * static_cast<double>(within) / std::sqrt(static_cast<double>(some.rays.size())));
        // As many of them in the inner half of the area, within 3 sigma.
        double inner = 0.0, inner_of_all = 0.0;
        for (const PlaneRay& ray : some.rays) inner += ray.place.norm() < 0.236;
        for (const PlaneRay& ray : all.rays) inner_of_all += ray.place.norm() < 0.236;
        const double count = static_cast<double>(some.rays.size());
        EXPECT_NEAR(inner / count, inner_of_all / static_cast<double>(all.rays.size()),
                    3.0 * 0.5 / std::sqrt(count));
    }
}

}  // namespace
}  // namespace petal
