// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "detectors/detail/board_line_pattern.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "petal/calibration/angles.hpp"

namespace petal {
namespace {

constexpr int kFifths = 5;
constexpr int kMaxSteps = 5000;            ///< 20 m of shifts: farther points are not of one board
constexpr double kLineTolerance = 0.008;   ///< m: a point is on a line of the pattern
constexpr double kPointTolerance = 0.018;  ///< m: a point is on a side, before the refinement
constexpr double kShiftStep = 0.004;       ///< m
constexpr double kSameShift = 0.02;        ///< m of shift and inflation: two placements are one
constexpr std::size_t kPlacements = 10;    ///< of each direction, before both are scored together

/// Where the pattern of one direction may lie: its zero is at `shift`.
struct Placement {
    double shift = 0.0;
    double inflation = 0.0;
    double support = 0.0;
};

/// The best placements of one direction's lines on the points' coordinates across them. A line
/// counts the square root of its points: the board's outer edge has more points than any line of
/// its holes, and must not beat four of them.
std::vector<Placement> place_lines(const std::vector<HoleGrid::Line>& pattern,
                                   std::vector<double> coordinates, double max_inflation) {
    std::vector<Placement> all;
    if (coordinates.empty()) return all;
    std::sort(coordinates.begin(), coordinates.end());
    const auto count = [&](double at) {
        const auto first =
            std::lower_bound(coordinates.begin(), coordinates.end(), at - kLineTolerance);
        const auto last = std::upper_bound(first, coordinates.end(), at + kLineTolerance);
        return static_cast<double>(last - first);
    };
    const double begin = coordinates.front() - pattern.back().at;
    const int steps =
        static_cast<int>((coordinates.back() - pattern.front().at - begin) / kShiftStep);
    for (int i = 0; i <= std::min(steps, kMaxSteps); ++i) {
        for (const double inflation : {0.0, max_inflation / 2.0, -max_inflation / 2.0}) {
            Placement placement{begin + i * kShiftStep, inflation, 0.0};
            for (const HoleGrid::Line& line : pattern)
                placement.support +=
                    std::sqrt(count(placement.shift + line.at + line.outward * inflation));
            all.push_back(placement);
        }
    }
    std::stable_sort(all.begin(), all.end(),
                     [](const auto& a, const auto& b) { return a.support > b.support; });
    std::vector<Placement> kept;
    for (const Placement& placement : all) {
        if (kept.size() == kPlacements) break;
        if (std::none_of(kept.begin(), kept.end(), [&](const Placement& other) {
                return std::abs(other.shift - placement.shift) +
                           std::abs(other.inflation - placement.inflation) <
                       kSameShift;
            }))
            kept.push_back(placement);
    }
    return kept;
}

}  // namespace

double PatternScore::coverage() const {
    return coverages.empty() ? 0.0
                             : std::accumulate(coverages.begin(), coverages.end(), 0.0) /
                                   static_cast<double>(coverages.size());
}

std::size_t PatternScore::sides_covered(double min_coverage) const {
    return static_cast<std::size_t>(std::count_if(coverages.begin(), coverages.end(),
                                                  [&](double c) { return c >= min_coverage; }));
}

PatternScorer::PatternScorer(const HoleGrid& grid, const Eigen::Vector2d& inflation,
                             double tolerance)
    : grid_(grid), inflation_(inflation), tolerance_(tolerance), fifths_(grid.side_count(), 0u) {
    score_.counts.assign(grid.side_count(), 0);
}

void PatternScorer::add(const Eigen::Vector2d& p_board) {
    const SideHit hit = find_side(grid_, inflation_, p_board, tolerance_);
    if (hit.in_hole) ++score_.in_holes;
    if (hit.side < 0) return;
    ++score_.counts[static_cast<std::size_t>(hit.side)];
    ++score_.rim;
    const double inner = (hit.along - kPointTolerance) / (hit.length - 2.0 * kPointTolerance);
    if (!(inner >= 0.0 && inner < 1.0)) return;
    fifths_[static_cast<std::size_t>(hit.side)] |= 1u << static_cast<int>(inner * kFifths);
}

PatternScore PatternScorer::score() const {
    PatternScore score = score_;
    for (const unsigned bits : fifths_) {
        int set = 0;
        for (int fifth = 0; fifth < kFifths; ++fifth) set += (bits >> fifth) & 1u ? 1 : 0;
        score.coverages.push_back(static_cast<double>(set) / kFifths);
    }
    const double points = static_cast<double>(score.rim + score.in_holes);
    score.value =
        score.coverage() - (points > 0.0 ? static_cast<double>(score.in_holes) / points : 0.0);
    return score;
}

std::vector<ScoredPattern> place_pattern(const HoleGrid& grid, double angle,
                                         const std::vector<Eigen::Vector2d>& points,
                                         double max_inflation, std::size_t keep) {
    std::vector<ScoredPattern> scored;
    const int turns = grid.same_after_turns(1) ? 1 : grid.same_after_turns(2) ? 2 : 4;
    for (int turn = 0; turn < turns; ++turn) {
        const Eigen::Rotation2Dd to_plane(angle + turn * kPi / 2.0);
        std::vector<Eigen::Vector2d> rotated;
        std::vector<double> across, down;
        rotated.reserve(points.size());
        for (const auto& p : points) {
            rotated.push_back(to_plane.inverse() * p);
            across.push_back(rotated.back().x());
            down.push_back(rotated.back().y());
        }
        const auto along_x = place_lines(grid.x, std::move(across), max_inflation);
        const auto along_y = place_lines(grid.y, std::move(down), max_inflation);
        for (const Placement& x : along_x) {
            for (const Placement& y : along_y) {
                const Eigen::Vector2d origin(x.shift, y.shift);
                ScoredPattern pattern;
                pattern.pose = {to_plane.angle(), to_plane * origin, {x.inflation, y.inflation}};
                PatternScorer scorer(grid, pattern.pose.inflation, kPointTolerance);
                for (const auto& p : rotated) scorer.add(p - origin);
                pattern.score = scorer.score();
                scored.push_back(std::move(pattern));
            }
        }
    }
    std::stable_sort(scored.begin(), scored.end(),
                     [](const auto& a, const auto& b) { return a.score.value > b.score.value; });
    if (scored.size() > keep) scored.resize(keep);
    return scored;
}

LineSplit lines_of_pattern(const HoleGrid& grid, const LineSplit& split, const PatternPose& pose,
                           const std::vector<Eigen::Vector2d>& points, std::size_t min_points) {
    struct Sum {
        Eigen::Vector2d points = Eigen::Vector2d::Zero();
        std::size_t count = 0;
    };
    std::vector<Sum> vertical(grid.x.size()), horizontal(grid.y.size());
    const Eigen::Rotation2Dd to_board(-pose.angle);
    for (const auto& p : points) {
        const SideHit hit =
            find_side(grid, pose.inflation, to_board * (p - pose.origin), kPointTolerance);
        if (hit.side < 0) continue;
        const HoleGrid::Hole& hole = grid.holes[static_cast<std::size_t>(hit.side) / 4];
        const std::size_t line[4] = {hole.left, hole.right, hole.top, hole.bottom};
        const std::size_t side = static_cast<std::size_t>(hit.side) % 4;
        Sum& sum = (side < 2 ? vertical : horizontal)[line[side]];
        sum.points += p;
        ++sum.count;
    }
    LineSplit result;
    result.angle = pose.angle;
    // A quarter turn of the board against the split swaps what is horizontal.
    const bool swapped = std::abs(std::sin(pose.angle - split.angle)) > 0.5;
    result.horizontal.direction = (swapped ? split.vertical : split.horizontal).direction;
    result.vertical.direction = (swapped ? split.horizontal : split.vertical).direction;
    const auto fill = [&](LineFamily& family, const std::vector<Sum>& sums, Eigen::Index axis) {
        for (const Sum& sum : sums) {
            if (sum.count < min_points) continue;
            const Eigen::Vector2d mean = sum.points / static_cast<double>(sum.count);
            family.lines.push_back({(to_board * mean)(axis), sum.count, mean});
        }
    };
    fill(result.vertical, vertical, 0);
    fill(result.horizontal, horizontal, 1);
    return result;
}

}  // namespace petal
