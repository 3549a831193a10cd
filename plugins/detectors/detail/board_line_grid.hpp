// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <utility>
#include <vector>

#include "petal/calibration/target.hpp"

namespace petal {

/// A target whose holes are rectangles along x and y, seen as two families of parallel lines: the
/// sides of the holes. Board frame of Target, metres.
struct HoleGrid {
    /// The line at `at` + `outward` * d, where d is how far every hole is enlarged in that
    /// direction.
    struct Line {
        double at;
        double outward;  ///< -1 for left (upper) sides, +1 for right (lower) sides
    };
    struct Hole {
        std::size_t left, right;  ///< indices in x
        std::size_t top, bottom;  ///< indices in y
    };

    std::vector<Line> x;  ///< vertical lines, ascending
    std::vector<Line> y;  ///< horizontal lines, ascending
    std::vector<Hole> holes;
    std::vector<Eigen::Vector2d> corners;  ///< Target::corners()
    std::vector<std::pair<std::size_t, std::size_t>>
        crossings;  ///< of each corner: index in x, in y
    double width = 0.0;
    double height = 0.0;
    double thickness = 0.0;

    std::size_t side_count() const { return 4 * holes.size(); }
    /// The middle of the outline's bounding box.
    Eigen::Vector2d middle() const { return {width / 2.0, height / 2.0}; }
    /// True where a quarter (half) turn about middle() maps the holes onto themselves.
    bool same_after_turns(int quarter_turns) const;

    /// \throws Error when a hole is no rectangle along x and y, or when one line is the left side
    /// of one hole and the right side of another, so that enlarging the holes would split it.
    static HoleGrid of(const Target& target);
};

/// Where a point of the board's plane lies with respect to the sides of the holes.
struct SideHit {
    int side = -1;         ///< 4 * hole + 0 left, 1 right, 2 top, 3 bottom; -1 for none
    double along = 0.0;    ///< m along the side, from its left or upper end
    double length = 0.0;   ///< of the side, m
    double across = 0.0;   ///< coordinate less that of the side's line, m
    bool in_hole = false;  ///< inside a hole, farther than the tolerance from its sides
};

/// Assigns a point (board frame) to the nearest side of a hole within `tolerance` of it. A hole's
/// corners, which a beam of some width rounds, belong to no side.
SideHit find_side(const HoleGrid& grid, const Eigen::Vector2d& inflation, const Eigen::Vector2d& p,
                  double tolerance);

}  // namespace petal
