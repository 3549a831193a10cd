// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "metrics/detail/plate_edges.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "petal/calibration/polygon.hpp"

namespace petal {
namespace {

/// As PlateEdges::inside(), from all sides.
double inside_of_all(const Target& target, const Eigen::Vector2d& p) {
    double nearest = distance_to_polygon(target.outline, p);
    bool on_plate = inside_polygon(target.outline, p);
    for (const auto& hole : target.holes) {
        nearest = std::min(nearest, distance_to_polygon(hole, p));
        on_plate = on_plate && !inside_polygon(hole, p);
    }
    for (const Target::RoundHole& hole : target.round_holes) {
        const double outside = (p - hole.centre).norm() - hole.radius;
        nearest = std::min(nearest, std::abs(outside));
        on_plate = on_plate && outside >= 0.0;
    }
    return on_plate ? nearest : -nearest;
}

/// A plate without an edge parallel to the grid, and with a corner that points inward.
Target leaning() {
    Target target;
    target.outline = {{0.0, 0.1}, {0.7, 0.0}, {0.8, 0.6}, {0.4, 0.35}, {0.1, 0.7}};
    target.holes = {{{0.3, 0.2}, {0.45, 0.15}, {0.5, 0.28}}};
    target.round_holes = {{{0.2, 0.4}, 0.07}};
    return target;
}

TEST(PlateEdges, TheGridLeavesOutNothingThatMatters) {
    std::mt19937_64 random(5);
    std::uniform_real_distribution<double> anywhere(-0.4, 1.2);
    for (const Target& target : {leaning(), load_target("four_square_holes_500mm"),
                                 scaled(load_target("four_square_holes_500mm"), 30.0)}) {
        const PlateEdges edges(target);
        for (int i = 0; i < 20000; ++i) {
            const Eigen::Vector2d p =
                std::max(1.0, target.width()) * Eigen::Vector2d(anywhere(random), anywhere(random));
            const double inside = inside_of_all(target, p);
            ASSERT_EQ(edges.inside(p), inside) << p.transpose();
            const auto place = edges.near(p, 10.0 * target.width(), -1e3);
            ASSERT_TRUE(place) << p.transpose();
            // Beyond the end of a side the distance to its line is less.
            ASSERT_LE(std::abs(place->inside), std::abs(inside) + 1e-12) << p.transpose();
            if (const auto beside = edges.near(p, 10.0 * target.width(), 0.0)) {
                ASSERT_NEAR(beside->inside, inside, 1e-12) << p.transpose();
            }
        }
    }
}

TEST(PlateEdges, APlaceThatIsNoNumberIsOnNoPlate) {
    const PlateEdges edges(leaning());
    const double nan = std::numeric_limits<double>::quiet_NaN();
    EXPECT_FALSE(edges.inside({nan, 0.2}) > 0.0);
    EXPECT_FALSE(edges.inside({std::numeric_limits<double>::infinity(), 0.2}) > 0.0);
}

}  // namespace
}  // namespace petal
