// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "detectors/detail/lidar_template_shape.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "detectors/detail/lidar_template_placement.hpp"
#include "noise.hpp"
#include "petal/calibration/angles.hpp"
#include "petal/calibration/polygon.hpp"

namespace petal {
namespace {

using testing::uniform;

class PlateShapes : public ::testing::TestWithParam<std::string> {
   protected:
    Target target_ = load_target(GetParam());
    Rng rng_{5};

    Eigen::Vector2d somewhere(const PlateShape& shape) {
        const double reach = 2.0 * shape.radius();
        const double x = uniform(rng_, -reach, reach);
        return {x, uniform(rng_, -reach, reach)};
    }
};

TEST_P(PlateShapes, WhatIsBeyondABandIsWhatTheDistanceSays) {
    for (const auto sides : {PlateShape::Sides::all, PlateShape::Sides::holes}) {
        const PlateShape shape(target_, sides);
        for (int i = 0; i < 20000; ++i) {
            const Eigen::Vector2d p = somewhere(shape);
            const double band = uniform(rng_, 0.0, 0.05), inside = shape.edge(p).inside;
            const int expected = inside > band ? 1 : inside < -band ? -1 : 0;
            ASSERT_EQ(shape.beyond(p, band), expected) << p.transpose() << " band " << band;
        }
    }
}

TEST_P(PlateShapes, TheNearestEdgeIsThatOfTheTargetsPolygonsAndCircles) {
    const PlateShape all(target_, PlateShape::Sides::all), holes(target_, PlateShape::Sides::holes);
    for (int i = 0; i < 20000; ++i) {
        const Eigen::Vector2d p = somewhere(all), at = p + all.middle();
        double nearest = std::numeric_limits<double>::infinity();
        int hole = -1, index = 0;
        for (const auto& polygon : target_.holes) {
            nearest = std::min(nearest, distance_to_polygon(polygon, at));
            if (inside_polygon(polygon, at)) hole = index;
            ++index;
        }
        for (const auto& circle : target_.round_holes) {
            const double off = (at - circle.centre).norm() - circle.radius;
            nearest = std::min(nearest, std::abs(off));
            if (off < 0.0) hole = index;
            ++index;
        }
        const PlateShape::Edge of_holes = holes.edge(p), of_all = all.edge(p);
        ASSERT_NEAR(of_holes.inside, hole < 0 ? nearest : -nearest, 1e-12) << p.transpose();
        if (hole >= 0) {
            ASSERT_EQ(holes.hole_of(of_holes.side), hole) << p.transpose();
        }
        const double rim = distance_to_polygon(target_.outline, at);
        const bool plate = hole < 0 && inside_polygon(target_.outline, at);
        const double least = std::min(nearest, rim);
        ASSERT_NEAR(of_all.inside, plate ? least : -least, 1e-12) << p.transpose();
        ASSERT_EQ(all.hole_of(of_all.side) < 0, rim < nearest) << p.transpose();
        // Off the board a step along it comes as much nearer.
        if (of_all.inside < -1e-3 && hole < 0) {
            ASSERT_NEAR(all.edge(p + 1e-4 * of_all.inward).inside, of_all.inside + 1e-4, 1e-7);
        }
    }
}

TEST_P(PlateShapes, TheZoneEndsAtTheRimOrBeyondTheOutline) {
    const PlateShape holes(target_, PlateShape::Sides::holes), all(target_, PlateShape::Sides::all);
    for (int i = 0; i < 20000; ++i) {
        const Eigen::Vector2d p = somewhere(all);
        const double off = all.distance_to_outline(p);
        ASSERT_EQ(all.in_zone(p), all.in_outline(p) || off <= all.reach()) << p.transpose();
        ASSERT_EQ(holes.in_zone(p), all.in_outline(p) && off >= holes.rim()) << p.transpose();
    }
}

/// Rays on a raster over the plane, told by the target itself.
TEST_P(PlateShapes, ATargetIsPlacedWhereItsRaysAre) {
    const PlateShape shape(target_, PlateShape::Sides::all);
    const double radius = 1.3 * shape.radius();
    const Eigen::Vector2d middle(0.06, -0.04);
    const double angle = 9.0 / kDegrees;
    RayBundle bundle;
    bundle.radius = radius;
    bundle.hit_depth = 0.01;
    for (double x = -radius; x <= radius; x += 0.004)
        for (double y = -radius; y <= radius; y += 0.004) {
            PlaneRay ray;
            ray.place = {x, y};
            const Eigen::Vector2d p = Eigen::Rotation2Dd(-angle) * (ray.place - middle);
            ray.beyond = shape.on_plate(p) ? 0.0 : 1.0;
            bundle.rays.push_back(ray);
        }
    const auto placements = PlatePlacer(shape, radius).place(bundle, 1, 0.4);
    ASSERT_EQ(placements.size(), 1u);
    // Cells are 1/32 of the lesser side, turns 3.5 deg apart.
    EXPECT_LT((placements[0].middle - middle).norm(), shape.least_side() / 32.0);
    const double whole = 2.0 * kPi / shape.symmetry();
    EXPECT_LT(std::abs(std::remainder(placements[0].angle - angle, whole)) * kDegrees, 3.6);
    EXPECT_GT(placements[0].score, 0.8);
}

INSTANTIATE_TEST_SUITE_P(Shipped, PlateShapes,
                         ::testing::Values("four_square_holes_500mm", "four_round_holes_aruco",
                                           "four_square_holes_1000mm"));

}  // namespace
}  // namespace petal
