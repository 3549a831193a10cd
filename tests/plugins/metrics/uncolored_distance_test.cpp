// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "metrics/uncolored_distance.hpp"

#include <gtest/gtest.h>

#include "metrics/detail/displayed_edges.hpp"
#include "plugins/metrics/table_three.hpp"

namespace petal {
namespace {

using table_three::figure_of;
using table_three::measured;

TEST(UncoloredDistanceTest, AShiftMovesTheEdgesAcrossIt) {
    // Colours are displayed 2 cm to the side: upright edges lie 2 cm off, level ones slide along
    // themselves.
    const auto stage =
        measured<UncoloredDistance>(table_three::pose({0.02, 0.0, 0.0}), table_three::pairs());
    EXPECT_NEAR(figure_of(stage, "uncolored_distance.max").value(), 0.02, 1e-9);
    EXPECT_EQ(figure_of(stage, "uncolored_distance.count"), 16.0);
    EXPECT_NEAR(figure_of(stage, "uncolored_distance.mean", "hall").value(), 0.01, 1e-9);
}

TEST(UncoloredDistanceTest, NoErrorIsNoDistance) {
    const auto stage =
        measured<UncoloredDistance>(table_three::pose({0.0, 0.0, 0.0}), table_three::pairs());
    EXPECT_LT(figure_of(stage, "uncolored_distance.max").value(), 1e-12);
}

TEST(UncoloredDistanceTest, ATurnMovesFarEndsMost) {
    // A turn about the axis moves a place by angle times its distance from the axis; an edge by
    // what is across it. The farthest corners lie 0.15 m from the axis in x and y.
    Extrinsics turned = table_three::pose({0.0, 0.0, 0.0});
    turned.cameras[0].T_camera_lidar.linear() =
        Eigen::AngleAxisd(0.01, Eigen::Vector3d::UnitZ()).toRotationMatrix();
    const auto stage = measured<UncoloredDistance>(turned, table_three::pairs());
    EXPECT_NEAR(figure_of(stage, "uncolored_distance.max").value(), 0.01 * 0.15, 2e-5);
}

TEST(UncoloredDistanceTest, ABoardBehindTheCameraIsTold) {
    const auto stage =
        measured<UncoloredDistance>(table_three::pose({0.0, 0.0, -5.0}), table_three::pairs());
    EXPECT_EQ(figure_of(stage, "uncolored_distance.count"), 0.0);
    EXPECT_EQ(stage.notes().size(), 1u);
}

TEST(UncoloredDistanceTest, HolesHaveTheirSides) {
    const Target target = load_target(table_three::kBoard);
    const auto sides = hole_sides(target);
    ASSERT_EQ(sides.size(), 16u);
    const auto corners = target.corners();
    for (const auto& [from, to] : sides)
        EXPECT_NEAR(
            (corners[static_cast<std::size_t>(from)] - corners[static_cast<std::size_t>(to)])
                .norm(),
            0.1, 1e-12);
}

}  // namespace
}  // namespace petal
