// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulation/lidar/scan_pattern.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <utility>

namespace petal::simulation {
namespace {

constexpr double kToDeg = 180.0 / 3.14159265358979323846;
constexpr double kRosetteRim = 35.2;  // deg

double off_axis_deg(const Eigen::Vector3d& d) {
    return std::atan2(d.tail<2>().norm(), d.x()) * kToDeg;
}

double elevation_deg(const Eigen::Vector3d& d) {
    return std::atan2(d.z(), d.head<2>().norm()) * kToDeg;
}

TEST(OffAxis, IsAUnitVectorAtThatAngle) {
    EXPECT_EQ(off_axis({0.0, 0.0}), Eigen::Vector3d::UnitX());
    const Eigen::Vector3d d = off_axis({0.3, 0.4});
    EXPECT_NEAR(d.norm(), 1.0, 1e-15);
    EXPECT_NEAR(std::acos(d.x()), 0.5, 1e-12);
    EXPECT_NEAR(d.z() / d.y(), 4.0 / 3.0, 1e-12);
}

TEST(Mid70Pattern, FillsACircleOf70Degrees) {
    const ScanPattern pattern(load_lidar_profile("livox_mid70"), 0.0);
    double widest = 0.0;
    for (std::int64_t pulse = 0; pulse < 100000; ++pulse) {
        const Eigen::Vector3d d = pattern.direction(pulse);
        ASSERT_NEAR(d.norm(), 1.0, 1e-12);
        widest = std::max(widest, off_axis_deg(d));
    }
    EXPECT_LE(widest, kRosetteRim + 1e-9);
    EXPECT_GT(widest, kRosetteRim - 0.01);
}

// Two equal prisms that turn independently: the angle off the axis is R |cos u| with u spread
// evenly, so that a share 2/pi asin(r/R) lies within r: per area 1 / (pi^2 r sqrt(R^2 - r^2)).
TEST(Mid70Pattern, IsDensestAtTheCentreAsTheLawOfTheRosetteSays) {
    const ScanPattern pattern(load_lidar_profile("livox_mid70"), 3.0);
    constexpr int kPulses = 1000000;
    constexpr std::size_t kRings = 32;  // 1.1 deg
    std::array<int, kRings> counts{};
    std::array<int, 8> octants{};
    for (std::int64_t pulse = 0; pulse < kPulses; ++pulse) {
        const Eigen::Vector3d d = pattern.direction(pulse);
        const double r = off_axis_deg(d) / kRosetteRim;
        ++counts[std::min(kRings - 1, static_cast<std::size_t>(r * kRings))];
        const double turned = std::atan2(d.z(), d.y()) / 6.283185307179586 + 0.5;
        ++octants[std::min<std::size_t>(7, static_cast<std::size_t>(turned * 8.0))];
    }
    int sum = 0;
    for (std::size_t ring = 0; ring < kRings; ++ring) {
        sum += counts[ring];
        const double r = static_cast<double>(ring + 1) / kRings;
        // 10 s are 2000 strokes over the field: even to far below a percent of all.
        EXPECT_NEAR(static_cast<double>(sum) / kPulses, 2.0 / 3.14159265 * std::asin(r), 0.002);
    }
    for (const int count : octants) EXPECT_NEAR(8.0 * count / kPulses, 1.0, 0.02);
    // Per area the innermost ring has 1 / (1/32)^2 times the law's 2/pi asin(1/32): 20 times the
    // mean.
    EXPECT_NEAR(1024.0 * counts[0] / kPulses, 20.4, 0.4);
}

TEST(Mid70Pattern, FillsItsGapsAsTimePasses) {
    const ScanPattern pattern(load_lidar_profile("livox_mid70"), 0.0);
    std::set<std::pair<int, int>> cells;  // of 0.3 deg: a little more than the footprint
    std::array<double, 3> seen{};
    std::int64_t pulse = 0;
    const std::array<std::int64_t, 3> until = {10000, 100000, 1000000};
    for (std::size_t i = 0; i < until.size(); ++i) {
        for (; pulse < until[i]; ++pulse) {
            const Eigen::Vector3d d = pattern.direction(pulse);
            const double scale = off_axis_deg(d) / std::max(1e-9, d.tail<2>().norm()) / 0.3;
            cells.emplace(static_cast<int>(std::floor(d.y() * scale)),
                          static_cast<int>(std::floor(d.z() * scale)));
        }
        seen[i] = static_cast<double>(cells.size()) * 0.09 / (3.14159 * kRosetteRim * kRosetteRim);
    }
    EXPECT_LT(seen[0], 0.25) << "a flower with few petals in 0.1 s";
    EXPECT_GT(seen[1], 2.0 * seen[0]);
    EXPECT_GT(seen[2], 0.97);
}

TEST(Mid70Pattern, DoesNotCloseIn20Seconds) {
    const ScanPattern pattern(load_lidar_profile("livox_mid70"), 0.0);
    const auto distance_deg = [&](std::int64_t a, std::int64_t b) {
        return (pattern.direction(a) - pattern.direction(b)).norm() * kToDeg;
    };
    // Two curves are one where they are near for a while: here over 1 ms.
    for (std::int64_t later = 50; later < 2000000; ++later) {
        if (distance_deg(0, later) > 0.02) continue;
        EXPECT_GT(std::max(distance_deg(50, later + 50), distance_deg(100, later + 100)), 0.02)
            << "after " << later << " pulses";
    }
}

TEST(AviaPattern, IsHigherThanWide) {
    const ScanPattern pattern(load_lidar_profile("livox_avia"), 0.0);
    double widest = 0.0, highest = 0.0;
    for (std::int64_t pulse = 0; pulse < 480000; ++pulse) {
        const Eigen::Vector3d d = pattern.direction(pulse);
        const double scale = off_axis_deg(d) / std::max(1e-9, d.tail<2>().norm());
        widest = std::max(widest, std::abs(d.y() * scale));
        highest = std::max(highest, std::abs(d.z() * scale));
    }
    EXPECT_NEAR(2.0 * widest, 70.4, 0.1);
    EXPECT_NEAR(2.0 * highest, 77.2, 0.1);
}

TEST(Mid360Pattern, SeesAllAroundFromMinus7To52Degrees) {
    const ScanPattern pattern(load_lidar_profile("livox_mid360"), 0.0);
    std::array<int, 36> sectors{};
    std::array<int, 10> bands{};
    constexpr int kPulses = 200000;
    for (std::int64_t pulse = 0; pulse < kPulses; ++pulse) {
        const Eigen::Vector3d d = pattern.direction(pulse);
        const double up = (elevation_deg(d) + 7.0) / 59.0;
        ASSERT_GE(up, -1e-9);
        ASSERT_LE(up, 1.0 + 1e-9);
        ++bands[std::min<std::size_t>(9, static_cast<std::size_t>(std::max(0.0, up) * 10.0))];
        const double turned = std::atan2(d.y(), d.x()) / 6.283185307179586 + 0.5;
        ++sectors[std::min<std::size_t>(35, static_cast<std::size_t>(turned * 36.0))];
    }
    // 10.013 turns: one sector of 10 deg has half a visit more than the ten of the others.
    for (const int count : sectors) EXPECT_NEAR(36.0 * count / kPulses, 1.0, 0.06);
    for (const int count : bands) EXPECT_NEAR(10.0 * count / kPulses, 1.0, 0.02);
}

TEST(SpinningPattern, Has32RingsAndTenTurnsASecond) {
    const LidarProfile profile = load_lidar_profile("spinning_32");
    const ScanPattern pattern(profile, 0.0);
    for (std::int64_t pulse = 0; pulse < 320; ++pulse)
        EXPECT_NEAR(elevation_deg(pattern.direction(pulse)), 15.0 - static_cast<double>(pulse % 32),
                    1e-9);
    const auto turn = static_cast<std::int64_t>(profile.points_per_second / 10.0);
    EXPECT_LT((pattern.direction(turn + 64) - pattern.direction(64)).norm(), 1e-9);
    const Eigen::Vector3d quarter = pattern.direction(turn / 4);
    EXPECT_NEAR(std::atan2(quarter.y(), quarter.x()) * kToDeg, 90.0, 1e-9);
}

}  // namespace
}  // namespace petal::simulation
