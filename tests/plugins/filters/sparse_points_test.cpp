// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "filters/sparse_points.hpp"

#include <gtest/gtest.h>

#include <random>
#include <utility>

#include "plugins/filters/cloud_samples.hpp"

namespace petal {
namespace {

using ::testing::ElementsAre;
using testing::kept_by;
using testing::Points;
using testing::StageHarness;

StageHarness descriptor_n(double distance, int min_neighbours) {
    auto stage = StageHarness::of<SparsePoints>("filter.sparse_points");
    stage.set("distance", distance).set("min_neighbours", min_neighbours);
    return stage;
}

TEST(SparsePointsStage, CountsTheOthersThatAreNearer) {
    // "Smaller than the threshold": the two at exactly 0.5 m do not count, unlike a point's double.
    const Points points = {{0, 0, 0}, {0.5F, 0, 0}, {0.75F, 0, 0}, {3, 0, 0}, {3, 0, 0}};
    auto one = descriptor_n(0.5, 1);
    EXPECT_THAT(kept_by(one, points), ElementsAre(1, 2, 3, 4));
    auto two = descriptor_n(0.5, 2);
    EXPECT_TRUE(kept_by(two, points).empty());
    ASSERT_EQ(two.notes().size(), 1U);
    EXPECT_EQ(two.notes()[0].threshold, "min_neighbours 2, distance 0.5 m");
}

/// Dense and sparse clumps on all sides of the origin.
Points sparse_and_dense() {
    std::mt19937_64 engine(11);
    Points points;
    for (int clump = 0; clump < 30; ++clump) {
        const float size = clump % 3 == 0 ? 0.05F : 0.8F;
        const float x = testing::draw(engine, -2, 2), y = testing::draw(engine, -2, 2);
        for (int i = 0; i < 50; ++i)
            points.push_back({x + testing::draw(engine, -size, size),
                              y + testing::draw(engine, -size, size),
                              testing::draw(engine, -size, size)});
    }
    return points;
}

TEST(SparsePointsStage, TheSameAsCountingAllPairs) {
    const Points points = sparse_and_dense();
    for (const auto& [distance, enough] :
         {std::pair(0.1, 1), std::pair(0.2, 6), std::pair(0.5, 30)}) {
        std::vector<std::uint32_t> expected;
        for (std::uint32_t i = 0; i < points.size(); ++i) {
            int count = -1;  // it finds itself
            for (const auto& other : points) {
                double square = 0.0;
                for (std::size_t axis = 0; axis < 3; ++axis) {
                    const double d =
                        static_cast<double>(points[i][axis]) - static_cast<double>(other[axis]);
                    square += d * d;
                }
                count += square < distance * distance;
            }
            if (count >= enough) expected.push_back(i);
        }
        auto stage = descriptor_n(distance, enough);
        EXPECT_EQ(kept_by(stage, points), expected) << distance;
    }
}

TEST(SparsePointsStage, IsAGoodRemover) {
    testing::expect_good_remover([] { return descriptor_n(0.1, 5); }, sparse_and_dense());
}

}  // namespace
}  // namespace petal
