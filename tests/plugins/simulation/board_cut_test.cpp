// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulation/scene/board_cut.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "simulation/scene/scene_file.hpp"

namespace petal::simulation {
namespace {

constexpr double kCutSigma = 0.0002;  // m

/// The sum of squares of how far a rectangle's sides lie off another's, and how parallel they are.
double squares_off(const std::vector<Eigen::Vector2d>& cut,
                   const std::vector<Eigen::Vector2d>& drawn) {
    double squares = 0.0;
    for (std::size_t i = 0; i < drawn.size(); ++i) {
        const std::size_t next = (i + 1) % drawn.size();
        const Eigen::Vector2d along = (drawn[next] - drawn[i]).normalized();
        const Eigen::Vector2d across(along.y(), -along.x());
        const double here = across.dot(cut[i] - drawn[i]);
        EXPECT_NEAR(here, across.dot(cut[next] - drawn[next]), 1e-12) << "a side is turned";
        squares += here * here;
    }
    return squares;
}

// 20 sides of 100 boards: their RMS is known to 1.6 %; 3 sigma of that.
TEST(BoardCut, MovesEverySideByItsOwnError) {
    const Target target = load_target("four_square_holes_500mm");
    double squares = 0.0;
    for (std::uint64_t seed = 1; seed <= 100; ++seed) {
        Engine engine(seed);
        const Target cut = cut_board(target, kCutSigma, engine);
        ASSERT_EQ(cut.holes.size(), 4U);
        squares += squares_off(cut.outline, target.outline);
        for (std::size_t k = 0; k < 4; ++k) squares += squares_off(cut.holes[k], target.holes[k]);
    }
    EXPECT_NEAR(std::sqrt(squares / 2000.0), kCutSigma, 0.05 * kCutSigma);
}

TEST(BoardCut, RoundHolesMoveAndChangeTheirSize) {
    const Target target = load_target("four_round_holes_aruco");
    Engine engine(3);
    const Target cut = cut_board(target, kCutSigma, engine);
    for (std::size_t k = 0; k < target.round_holes.size(); ++k) {
        const double moved = (cut.round_holes[k].centre - target.round_holes[k].centre).norm();
        const double larger = std::abs(cut.round_holes[k].radius - target.round_holes[k].radius);
        EXPECT_GT(moved, 0.0);
        EXPECT_LT(moved, 6.0 * kCutSigma);
        EXPECT_GT(larger, 0.0);
        EXPECT_LT(larger, 5.0 * kCutSigma);
    }
}

TEST(BoardCut, WithoutErrorItIsTheTargetToTheLastBit) {
    const Target target = load_target("four_square_holes_500mm");
    Engine engine(1);
    const Target cut = cut_board(target, 0.0, engine);
    for (std::size_t k = 0; k < 4; ++k)
        for (std::size_t i = 0; i < 4; ++i) EXPECT_TRUE(cut.holes[k][i] == target.holes[k][i]);
}

/// Where the first hole's left side ends the board's front, m from where the target has it: looked
/// for straight before the board, to a micrometre.
double left_side_off(const Scene& scene) {
    const SceneBoard& board = scene.boards[0];
    const auto& hole = board.target.holes[0];
    const Eigen::Vector2d middle = 0.5 * (hole[0] + hole[2]);
    double plate = -0.002, open = 0.002;
    const double left = std::min(hole[0].x(), hole[2].x());
    while (open - plate > 1e-6) {
        const double at = 0.5 * (plate + open);
        const Eigen::Vector3d before =
            board.T_world_board * Eigen::Vector3d(left + at, middle.y(), -0.1);
        const Hit hit = scene.world.cast({before, board.T_world_board.linear().col(2)}, 0.1001);
        (hit.surface != nullptr ? plate : open) = at;
    }
    return plate;
}

TEST(BoardCut, TheCapturesOfARigShowTheSameBoard) {
    const SceneFile file = SceneFile::load("set_four_diverse");
    Rng rng(5);
    const Rig rig = file.make_rig({}, rng), other = file.make_rig({}, rng);
    const double first = left_side_off(file.make_scene(0, rng, rig.boards_seed));
    EXPECT_NEAR(left_side_off(file.make_scene(1, rng, rig.boards_seed)), first, 3e-6);
    EXPECT_NEAR(left_side_off(file.make_scene(3, rng, rig.boards_seed)), first, 3e-6);
    EXPECT_GT(std::abs(left_side_off(file.make_scene(0, rng, other.boards_seed)) - first), 1e-5);
}

}  // namespace
}  // namespace petal::simulation
