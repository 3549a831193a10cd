// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "solvers/detail/least_kept.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <utility>
#include <vector>

namespace petal {
namespace {

TEST(LeastKept, IsAStableSortCutOffWithoutHoldingEverything) {
    std::mt19937 random(1);
    LeastKept<int> kept(50);
    std::vector<std::pair<double, int>> all;
    for (int i = 0; i < 5000; ++i) {
        const double cost = static_cast<double>(random() % 40);  // many of each: ties decide
        all.emplace_back(cost, i);
        kept.add(cost, i);
        ASSERT_LE(kept.size(), 50U);
    }
    std::stable_sort(all.begin(), all.end(),
                     [](const auto& a, const auto& b) { return a.first < b.first; });
    const auto values = kept.take();
    ASSERT_EQ(values.size(), 50U);
    for (std::size_t i = 0; i < values.size(); ++i) EXPECT_EQ(values[i], all[i].second) << i;
}

TEST(LeastKept, FewerThanTheMostAreAllTold) {
    LeastKept<int> kept(3);
    kept.add(2.0, 20);
    kept.add(1.0, 10);
    EXPECT_EQ(kept.take(), (std::vector<int>{10, 20}));
    LeastKept<int> none(0);
    none.add(1.0, 1);
    EXPECT_TRUE(none.take().empty());
}

}  // namespace
}  // namespace petal
