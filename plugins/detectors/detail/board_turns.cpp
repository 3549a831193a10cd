// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "detectors/detail/board_turns.hpp"

#include <algorithm>

namespace petal {

namespace {

constexpr double kTurnedOnto = 1e-6;  ///< m: two board points closer than this are the same

}  // namespace

BoardTurns::BoardTurns(const std::vector<Eigen::Vector2d>& points, const Eigen::Vector2d& center) {
    turns_.clear();
    for (int quarter = 0; quarter < 4; ++quarter) {
        Eigen::Matrix2d turn;
        turn << (quarter == 0) - (quarter == 2), (quarter == 3) - (quarter == 1),
            (quarter == 1) - (quarter == 3), (quarter == 0) - (quarter == 2);
        Homography board = Homography::Identity();
        board.topLeftCorner<2, 2>() = turn;
        board.topRightCorner<2, 1>() = center - turn * center;
        const bool same = std::all_of(points.begin(), points.end(), [&](const auto& p) {
            const Eigen::Vector2d turned = center + turn * (p - center);
            return std::any_of(points.begin(), points.end(),
                               [&](const auto& q) { return (turned - q).norm() < kTurnedOnto; });
        });
        if (same) turns_.push_back(board);
    }
}

bool BoardTurns::is_upright(const Eigen::Matrix2d& jacobian) const {
    const auto score = [](const Eigen::Matrix2d& j) {
        return j(0, 0) / j.col(0).norm() + j(1, 1) / j.col(1).norm();
    };
    const double own = score(jacobian);
    return std::all_of(turns_.begin(), turns_.end(), [&](const Homography& turn) {
        return score(jacobian * turn.topLeftCorner<2, 2>()) <= own + 1e-9;
    });
}

}  // namespace petal
