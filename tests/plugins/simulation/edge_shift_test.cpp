// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

// Holes of 0.1 m measured in simulated points, against what real points of a Mid-70 give: 76 to 96
// mm at 4.7 m with a far background, less in the vertical; 97 to 106 mm at 3 m with a wall 10 to 50
// cm behind.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "plugins/simulation/camera_worlds.hpp"
#include "plugins/simulation/lidar_worlds.hpp"

namespace petal::simulation {
namespace {

using ::testing::AllOf;
using ::testing::Ge;
using ::testing::Le;

constexpr double kDegreeOfEdges = 3.14159265358979323846 / 180.0;

/// How far apart the points on both sides of a hole end, in strips 5 mm wide: the median over
/// strips.
double hole_side(const std::vector<Eigen::Vector2d>& board, const Eigen::Vector2d& middle,
                 int axis) {
    constexpr std::size_t kStrips = 16;
    constexpr double kStrip = 0.005;  // m; together 80 of the 100 mm
    std::array<double, kStrips> below, above;
    below.fill(-1.0);
    above.fill(1.0);
    for (const Eigen::Vector2d& point : board) {
        const Eigen::Vector2d p = point - middle;
        const double strip = std::floor(p(1 - axis) / kStrip + 0.5 * kStrips);
        if (strip < 0.0 || strip >= static_cast<double>(kStrips)) continue;
        const auto i = static_cast<std::size_t>(strip);
        if (p(axis) < 0.0) below[i] = std::max(below[i], p(axis));
        if (p(axis) >= 0.0) above[i] = std::min(above[i], p(axis));
    }
    std::array<double, kStrips> sides{};
    for (std::size_t i = 0; i < kStrips; ++i) sides[i] = above[i] - below[i];
    std::nth_element(sides.begin(), sides.begin() + kStrips / 2, sides.end());
    return sides[kStrips / 2];
}

struct Sides {
    double across_mm = 0.0;  ///< mean over the four holes
    double upright_mm = 0.0;
};

/// The board at `range`, a wall `behind` it; points within `tolerance` of the board's plane.
Sides measured_sides(double range, double behind, double tolerance) {
    World world;
    add_four_holes(world, range, 0.8F);
    add_wall(world, range + behind, 60.0, 0.55F);
    world.build();
    LidarDevice device;
    device.profile = load_lidar_profile("livox_mid70");
    // The middle of the field alone, where 2.6 s give as many points as 10 s do in the whole.
    device.profile.pattern.deflections = {4.5 * kDegreeOfEdges, 4.5 * kDegreeOfEdges};
    const auto messages =
        simulate_lidar(world, device, Motion{}, 2.6, 7, petal::testing::BareRun());
    const Eigen::Matrix3Xd points = points_of(messages);
    std::vector<Eigen::Vector2d> board;
    for (Eigen::Index i = 0; i < points.cols(); ++i)
        if (std::abs(points(0, i) - range) <= tolerance && points.col(i).tail<2>().norm() < 0.5)
            board.emplace_back(-points(1, i), -points(2, i));
    Sides sides;
    for (const double x : {-0.1, 0.1})
        for (const double y : {-0.1, 0.1}) {
            sides.across_mm += 250.0 * hole_side(board, {x, y}, 0);
            sides.upright_mm += 250.0 * hole_side(board, {x, y}, 1);
        }
    return sides;
}

constexpr double kThreeSigma =
    0.037;  // m, of the Mid-70's range noise on a white board at 3 to 5 m

TEST(EdgeShift, HolesBeforeAFarBackgroundAreTooSmallMoreSoUpright) {
    const Sides sides = measured_sides(4.7, 5.0, kThreeSigma);
    EXPECT_THAT(sides.across_mm, AllOf(Ge(90.0), Le(96.0)));
    EXPECT_THAT(sides.upright_mm, AllOf(Ge(76.0), Le(85.0)));
}

TEST(EdgeShift, HolesBeforeAWallAreNearlyTrue) {
    for (const double behind : {0.1, 0.25, 0.5}) {
        SCOPED_TRACE(behind);
        const Sides sides = measured_sides(3.0, behind, kThreeSigma);
        EXPECT_THAT(sides.across_mm, AllOf(Ge(97.0), Le(106.0)));
        EXPECT_THAT(sides.upright_mm, AllOf(Ge(97.0), Le(106.0)));
    }
}

}  // namespace
}  // namespace petal::simulation
