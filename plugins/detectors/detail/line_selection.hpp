// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <vector>

#include "detectors/detail/line_search.hpp"

namespace petal {

/// Parallel lines: those of one direction of a board.
struct LineFamily {
    struct Line {
        double at = 0.0;        ///< m: its coordinate across the family, in the board's rotation
        std::size_t count = 0;  ///< points
        Eigen::Vector2d point = Eigen::Vector2d::Zero();  ///< plane coordinates, m
    };
    Eigen::Vector2d direction = Eigen::Vector2d::Zero();  ///< (5), unit length
    std::vector<Line> lines;                              ///< by `at`, ascending
};

/// Lines split relative to the board.
struct LineSplit {
    double angle = 0.0;     ///< rad, (-pi/4, pi/4]: from the plane's x to the horizontal lines
    LineFamily horizontal;  ///< `at` is a y
    LineFamily vertical;    ///< `at` is an x
};

/// Finds the two perpendicular directions that carry the most points, from the lines themselves,
/// and splits the lines; those that run otherwise are left out. Each direction is the sum (5), its
/// vectors' signs aligned first (the letter does not say so; without it they cancel). `angle` is
/// the mean of both, weighted with their points. None without a line.
std::optional<LineSplit> split_lines(const std::vector<PlanarLine>& lines);

/// The letter's rules for what is left of one family, in this order:
/// 1. of two lines nearer than `min_distance` the one with fewer points goes (they coincide);
/// 2. two lines `board_length` +- `tolerance` apart go both (the board's edges);
/// 3. where one line more is left than `wanted.size()`, the one with the most points goes (the only
///    edge that is seen; the lower one is lost on the floor).
LineFamily select_by_letter(const LineFamily& family, double board_length, double min_distance,
                            double tolerance, std::size_t wanted);

}  // namespace petal
