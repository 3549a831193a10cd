// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "solvers/detail/board_symmetry.hpp"

#include <gtest/gtest.h>

#include "solvers/detail/assignment.hpp"

namespace petal {
namespace {

TEST(BoardSymmetry, ASquareHasFourRotationsAnOblongTwoAScaleneOne) {
    std::vector<Eigen::Vector3d> square, oblong;
    for (int i = 0; i < 16; ++i) {
        square.emplace_back(0.1 * (i % 4), 0.1 * (i / 4), 2.0);
        oblong.emplace_back(0.1 * (i % 4), 0.2 * (i / 4), 2.0);
    }
    EXPECT_EQ(board_rotations(square).size(), 4u);
    EXPECT_EQ(board_rotations(oblong).size(), 2u);
    EXPECT_EQ(board_rotations({{0, 0, 1}, {1, 0, 1}, {0.2, 0.6, 1}, {0.9, 0.3, 1}}).size(), 1u);
    for (std::size_t i = 0; i < 16; ++i) EXPECT_EQ(board_rotations(square)[0][i], i);
}

TEST(Assignment, TakesTheLeastSumAndLeavesDearOnesOut) {
    Eigen::MatrixXd cost(3, 2);
    cost << 1.0, 2.0, 1.1, 9.0, 8.0, 8.0;
    EXPECT_EQ(assign(cost, 5.0), (std::vector<int>{1, 0, -1}));
    EXPECT_EQ(assign(Eigen::MatrixXd::Constant(2, 2, 7.0), 5.0), (std::vector<int>{-1, -1}));
    EXPECT_EQ(assign(Eigen::MatrixXd(2, 0), 5.0), (std::vector<int>{-1, -1}));
}

}  // namespace
}  // namespace petal
