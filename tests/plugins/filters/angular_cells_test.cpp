// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "filters/detail/angular_cells.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <random>
#include <vector>

#include "petal/calibration/cloud.hpp"
#include "petal/testing/stage_harness.hpp"

namespace petal {
namespace {

using testing::StageHarness;

struct NoParams {};

/// Lends a test a Run.
class InsideRun final : public Stage {
   public:
    using Params = NoParams;
    static void describe(Spec<Params>& s) {
        s.summary("Calls a test.");
        s.reads<Cloud>("cloud", "points");
    }
    explicit InsideRun(Params) {}
    void run(Run& run) override { body(run); }
    static std::function<void(Run&)> body;
};
std::function<void(Run&)> InsideRun::body;

void inside_run(int threads, std::function<void(Run&)> body) {
    InsideRun::body = std::move(body);
    auto stage = StageHarness::of<InsideRun>();
    stage.threads(threads).give<Cloud>("cloud", Cloud());
    stage.fire();
    InsideRun::body = nullptr;
}

mrpt::maps::CPointsMapXYZI scattered(std::size_t count) {
    std::mt19937_64 engine(3);
    const auto drawn = [&engine] { return static_cast<float>(engine() % 2000001) * 1e-6F - 1.0F; };
    mrpt::maps::CPointsMapXYZI points;
    points.reserve(count);
    for (std::size_t i = 0; i < count; ++i) points.insertPointFast(drawn(), drawn(), drawn());
    return points;
}

TEST(AngularCells, AnglesAreThoseOfTheStandardLibrary) {
    auto points = scattered(20000);
    for (const float x : {1.0F, 0.0F, -1.0F})
        for (const float y : {1.0F, 0.0F, -1.0F}) points.insertPointFast(x, y, 0.5F);
    inside_run(1, [&](petal::Run& run) {
        const AngularCells cells(points, 0.1, run);
        EXPECT_EQ(cells.points().size(), points.size());
        for (const AngularPoint& p : cells.points()) {
            float x, y, z;
            points.getPoint(p.index, x, y, z);
            EXPECT_NEAR(p.azimuth, std::atan2(y, x), 1e-6);
            EXPECT_NEAR(p.elevation, std::atan2(z, std::hypot(x, y)), 1e-6);
            EXPECT_NEAR(p.range, std::hypot(x, y, z), 1e-6);
        }
    });
}

TEST(AngularCells, WhatHasNoDirectionIsNoPoint) {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const float infinity = std::numeric_limits<float>::infinity();
    mrpt::maps::CPointsMapXYZI points;
    points.insertPointFast(nan, 0.0F, 0.0F);
    points.insertPointFast(0.0F, 0.0F, 0.0F);
    points.insertPointFast(1.0F, infinity, 0.0F);
    points.insertPointFast(1.0F, 2.0F, nan);
    points.insertPointFast(1.0F, 2.0F, 3.0F);
    inside_run(1, [&](petal::Run& run) {
        const AngularCells cells(points, 0.01, run);
        ASSERT_EQ(cells.points().size(), 1U);
        EXPECT_EQ(cells.points()[0].index, 4U);
        EXPECT_EQ(cells.size(), 1U);
        EXPECT_EQ(cells.count(0), 1U);
    });
}

TEST(AngularCells, AnEmptyCloudHasNoCells) {
    inside_run(1, [](petal::Run& run) {
        const mrpt::maps::CPointsMapXYZI points;
        EXPECT_EQ(angular_density(points), 0.0);
        const AngularCells cells(points, 0.01, run);
        EXPECT_EQ(cells.size(), 0U);
        EXPECT_EQ(cells.row_begin(cells.rows()), 0U);
    });
}

/// Every point once, in the cell of its angles, the cells in order and the points in theirs: with a
/// coarse step (counted) and a fine one (rows of few points, sorted).
TEST(AngularCells, EveryPointLiesInItsCell) {
    const auto map = scattered(50000);
    for (const double step : {0.02, 0.0002})
        inside_run(2, [&](petal::Run& run) {
            const AngularCells cells(map, step, run);
            ASSERT_EQ(cells.points().size(), map.size());
            std::vector<int> seen(map.size());
            for (std::size_t row = 0; row < cells.rows(); ++row)
                for (std::size_t c = cells.row_begin(row); c < cells.row_begin(row + 1); ++c) {
                    if (c > cells.row_begin(row)) {
                        EXPECT_LT(cells.column(c - 1), cells.column(c));
                    }
                    EXPECT_GT(cells.count(c), 0U);
                    for (std::size_t i = cells.begin(c); i < cells.begin(c + 1); ++i) {
                        const AngularPoint& p = cells.points()[i];
                        ++seen[p.index];
                        // Angles are floats: 1e-6 rad is what they and the step are good for.
                        const double y = (p.elevation + M_PI_2) / step,
                                     x = (p.azimuth + M_PI) / step;
                        EXPECT_NEAR(y, static_cast<double>(row) + 0.5, 0.5 + 2e-6 / step);
                        EXPECT_NEAR(x, cells.column(c) + 0.5, 0.5 + 2e-6 / step);
                        if (i > cells.begin(c)) {
                            EXPECT_LT(cells.points()[i - 1].index, p.index);
                        }
                    }
                }
            EXPECT_EQ(seen, std::vector<int>(map.size(), 1));
        });
}

TEST(AngularCells, ThreadsDoNotChangeThem) {
    const auto map = scattered(100000);
    std::vector<std::uint32_t> order[2];
    for (const int threads : {1, 4})
        inside_run(threads, [&](petal::Run& run) {
            const AngularCells cells(map, 0.005, run);
            for (const AngularPoint& p : cells.points())
                order[threads == 1 ? 0 : 1].push_back(p.index);
        });
    EXPECT_EQ(order[0], order[1]);
}

TEST(AngularCells, DensityIsThatAroundMostPoints) {
    // 10 x 10 deg with a point every 0.1 deg: 100 points a square degree.
    mrpt::maps::CPointsMapXYZI points;
    for (int i = 0; i < 100; ++i)
        for (int k = 0; k < 100; ++k) {
            const double azimuth = (0.1 * i - 5.0) * M_PI / 180,
                         elevation = (0.1 * k - 5.0) * M_PI / 180;
            points.insertPointFast(static_cast<float>(std::cos(elevation) * std::cos(azimuth)),
                                   static_cast<float>(std::cos(elevation) * std::sin(azimuth)),
                                   static_cast<float>(std::sin(elevation)));
        }
    inside_run(1, [&](petal::Run&) {
        const double per_square_degree = angular_density(points) * std::pow(M_PI / 180, 2);
        EXPECT_NEAR(per_square_degree, 100.0, 10.0);
    });
}

}  // namespace
}  // namespace petal
