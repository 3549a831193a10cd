// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "detectors/detail/board_line_grid.hpp"
#include "detectors/detail/line_selection.hpp"

namespace petal {

/// A board in plane coordinates, and how far its holes are enlarged.
struct PatternPose {
    double angle = 0.0;                                ///< rad: from the plane's x to the board's x
    Eigen::Vector2d origin = Eigen::Vector2d::Zero();  ///< the board's origin, m
    Eigen::Vector2d inflation = Eigen::Vector2d::Zero();  ///< m: of the holes' sides, in x and in y
};

/// How well points support the sides of a board's holes.
struct PatternScore {
    std::vector<int> counts;  ///< of each side (see SideHit): its points
    /// Of each side: share of its fifths that hold a point; of that part of it where no point can
    /// be another side's (the tolerance off its ends).
    std::vector<double> coverages;
    std::size_t rim = 0;       ///< points on sides
    std::size_t in_holes = 0;  ///< points inside holes: they contradict
    double value = 0.0;        ///< mean coverage less in_holes / (rim + in_holes)

    double coverage() const;  ///< mean over the sides
    std::size_t sides_covered(double min_coverage) const;
};

/// Gathers PatternScore point by point; points are in the board's frame.
class PatternScorer {
   public:
    PatternScorer(const HoleGrid& grid, const Eigen::Vector2d& inflation, double tolerance);
    void add(const Eigen::Vector2d& p_board);
    PatternScore score() const;

   private:
    const HoleGrid& grid_;
    Eigen::Vector2d inflation_;
    double tolerance_;
    std::vector<unsigned> fifths_;  ///< a bit for each fifth of a side
    PatternScore score_;
};

struct ScoredPattern {
    PatternPose pose;
    PatternScore score;
};

/// Places the board's pattern of parallel lines on the points (plane coordinates) where most of
/// them lie on its lines, in the rotation `angle` (rad; also quarter turns from it where the target
/// looks different then), with inflations of 0 and +-`max_inflation` / 2; then scores both
/// directions together on the sides of the holes. The best first, at most `keep`.
std::vector<ScoredPattern> place_pattern(const HoleGrid& grid, double angle,
                                         const std::vector<Eigen::Vector2d>& points,
                                         double max_inflation, std::size_t keep);

/// The lines of a placed pattern, each through the mean of the points on its sides and in its
/// family's common direction (5); no spacing is imposed. A line with fewer than `min_points` is
/// left out.
LineSplit lines_of_pattern(const HoleGrid& grid, const LineSplit& split, const PatternPose& pose,
                           const std::vector<Eigen::Vector2d>& points, std::size_t min_points);

}  // namespace petal
