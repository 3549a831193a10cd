// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "detectors/detail/lidar_template_cells.hpp"

#include <gtest/gtest.h>
#include <tbb/task_arena.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <map>
#include <memory>
#include <set>
#include <vector>

#include "noise.hpp"

namespace petal {
namespace {

using testing::uniform;

Cloud cloud_with(const std::vector<Eigen::Vector3f>& points) {
    auto map = std::make_shared<mrpt::maps::CPointsMapXYZI>();
    for (const auto& p : points) map->insertPointFast(p.x(), p.y(), p.z());
    Cloud cloud;
    cloud.points = map;
    return cloud;
}

// More points than one thread takes at once; the cells' means by a plain sum.
TEST(PlateCells, HoldWhatLiesInThem) {
    constexpr double kSize = 0.05;
    constexpr int kCount = 700000, kLeast = 40;
    Rng rng(3);
    std::vector<Eigen::Vector3f> points;
    struct Sum {
        Eigen::Vector3d sum = Eigen::Vector3d::Zero();
        int count = 0;
    };
    std::map<std::array<int, 3>, Sum> expected;
    std::vector<std::array<int, 3>> order;
    for (int i = 0; i < kCount; ++i) {
        const double x = uniform(rng, -1.0, 1.0), y = uniform(rng, 3.0, 4.0);
        points.push_back(Eigen::Vector3d(x, y, -0.02).cast<float>());
        const Eigen::Vector3f scaled = static_cast<float>(1.0 / kSize) * points.back();
        const std::array<int, 3> at{static_cast<int>(std::floor(scaled.x())),
                                    static_cast<int>(std::floor(scaled.y())),
                                    static_cast<int>(std::floor(scaled.z()))};
        Sum& cell = expected[at];
        if (cell.count++ == 0) order.push_back(at);
        cell.sum += points.back().cast<double>();
    }
    // One cell that is as good as empty, and what lies nowhere.
    points.insert(points.begin(), {50.0F, 50.0F, 50.0F});
    points.insert(points.begin() + 7, {std::numeric_limits<float>::quiet_NaN(), 3.0F, 0.0F});
    points.insert(points.begin() + 8, {1e7F, 3.0F, 0.0F});
    const std::vector<PlateCell> cells = gather_cells(cloud_with(points), kSize, kLeast);
    ASSERT_EQ(cells.size(), order.size());
    for (std::size_t i = 0; i < cells.size(); ++i) {
        const Sum& sum = expected.at(order[i]);
        EXPECT_EQ(cells[i].count, sum.count);
        // Rounded at each of some 900 points, by 2^-24 of 4 m: 0.2 mm were all to add up.
        EXPECT_LT((cells[i].mean.cast<double>() - sum.sum / sum.count).norm(), 2e-5);
    }
}

TEST(PlateCells, AreTheSameForAnyNumberOfThreads) {
    Rng rng(4);
    std::vector<Eigen::Vector3f> points;
    for (int i = 0; i < 600000; ++i)
        points.push_back(
            Eigen::Vector3d(uniform(rng, 0.0, 3.0), uniform(rng, 0.0, 3.0), 1.0).cast<float>());
    const Cloud cloud = cloud_with(points);
    const auto with_threads = [&](int threads) {
        std::vector<PlateCell> cells;
        tbb::task_arena(threads).execute([&] { cells = gather_cells(cloud, 0.05, 2); });
        return cells;
    };
    const std::vector<PlateCell> one = with_threads(1), four = with_threads(4);
    ASSERT_EQ(one.size(), four.size());
    for (std::size_t i = 0; i < one.size(); ++i) {
        ASSERT_EQ(one[i].count, four[i].count);
        ASSERT_EQ(one[i].mean, four[i].mean);
    }
}

TEST(PlateCells, AnEmptyCloudHasNone) {
    EXPECT_TRUE(gather_cells(cloud_with({}), 0.05, 1).empty());
}

TEST(PlateCells, NumbersOfEitherSignAreKeptApart) {
    std::set<std::uint64_t> keys;
    for (int x : {-3, 0, 2})
        for (int y : {-1, 0, 1})
            for (int z : {-70000, 0, 70000}) keys.insert(cell_key({x, y, z}));
    EXPECT_EQ(keys.size(), 27u);
}

}  // namespace
}  // namespace petal
