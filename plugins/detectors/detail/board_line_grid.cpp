// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "detectors/detail/board_line_grid.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "petal/error.hpp"

namespace petal {
namespace {

constexpr double kSame = 1e-6;          ///< m: two coordinates of a target file are one
constexpr double kCornerMargin = 0.01;  ///< m: as far from a hole's corner its sides begin

std::size_t index_of(const std::vector<HoleGrid::Line>& lines, double at) {
    for (std::size_t i = 0; i < lines.size(); ++i)
        if (std::abs(lines[i].at - at) < kSame) return i;
    throw Error("the target's lines do not contain " + std::to_string(at) + " m");
}

void add_line(std::vector<HoleGrid::Line>& lines, double at, double outward, const Target& target) {
    for (const HoleGrid::Line& line : lines) {
        if (std::abs(line.at - at) >= kSame) continue;
        if (line.outward * outward > 0.0) return;
        throw Error("target '" + target.name + "': the line at " + std::to_string(at) +
                    " m is a left (upper) side of one hole and a right (lower) side of another; "
                    "board_lines needs holes with a gap between them");
    }
    lines.push_back({at, outward});
}

}  // namespace

HoleGrid HoleGrid::of(const Target& target) {
    HoleGrid grid;
    grid.width = target.width();
    grid.height = target.height();
    grid.thickness = target.thickness;
    grid.corners = target.corners();
    if (target.holes.empty())
        throw Error("target '" + target.name + "' shows " + target.features() +
                    "; board_lines needs rectangular holes: take another target or another "
                    "lidar_board_detector");
    struct Box {
        Eigen::Vector2d low, high;
    };
    std::vector<Box> boxes;
    for (const auto& hole : target.holes) {
        Box box{hole.front(), hole.front()};
        for (const auto& corner : hole) {
            box.low = box.low.cwiseMin(corner);
            box.high = box.high.cwiseMax(corner);
        }
        bool rectangle = hole.size() == 4;
        for (const auto& corner : hole)
            for (int axis = 0; axis < 2; ++axis)
                rectangle = rectangle && (std::abs(corner(axis) - box.low(axis)) < kSame ||
                                          std::abs(corner(axis) - box.high(axis)) < kSame);
        if (!rectangle)
            throw Error("target '" + target.name +
                        "' has a hole that is no rectangle along x and y; board_lines needs "
                        "rectangles: take another lidar_board_detector");
        boxes.push_back(box);
        add_line(grid.x, box.low.x(), -1.0, target);
        add_line(grid.x, box.high.x(), 1.0, target);
        add_line(grid.y, box.low.y(), -1.0, target);
        add_line(grid.y, box.high.y(), 1.0, target);
    }
    const auto ascending = [](const Line& a, const Line& b) { return a.at < b.at; };
    std::sort(grid.x.begin(), grid.x.end(), ascending);
    std::sort(grid.y.begin(), grid.y.end(), ascending);
    for (const Box& box : boxes)
        grid.holes.push_back({index_of(grid.x, box.low.x()), index_of(grid.x, box.high.x()),
                              index_of(grid.y, box.low.y()), index_of(grid.y, box.high.y())});
    for (const auto& corner : grid.corners)
        grid.crossings.emplace_back(index_of(grid.x, corner.x()), index_of(grid.y, corner.y()));
    return grid;
}

bool HoleGrid::same_after_turns(int quarter_turns) const {
    const Eigen::Vector2d centre = middle();
    return std::all_of(corners.begin(), corners.end(), [&](const Eigen::Vector2d& corner) {
        Eigen::Vector2d turned = corner - centre;
        for (int i = 0; i < quarter_turns; ++i) turned = Eigen::Vector2d(-turned.y(), turned.x());
        return std::any_of(corners.begin(), corners.end(), [&](const Eigen::Vector2d& other) {
            return (other - centre - turned).norm() < kSame;
        });
    });
}

SideHit find_side(const HoleGrid& grid, const Eigen::Vector2d& inflation, const Eigen::Vector2d& p,
                  double tolerance) {
    SideHit hit;
    for (std::size_t h = 0; h < grid.holes.size(); ++h) {
        const HoleGrid::Hole& hole = grid.holes[h];
        const double left = grid.x[hole.left].at - inflation.x();
        const double right = grid.x[hole.right].at + inflation.x();
        const double top = grid.y[hole.top].at - inflation.y();
        const double bottom = grid.y[hole.bottom].at + inflation.y();
        if (p.x() < left - tolerance || p.x() > right + tolerance || p.y() < top - tolerance ||
            p.y() > bottom + tolerance)
            continue;
        const double across[4] = {p.x() - left, p.x() - right, p.y() - top, p.y() - bottom};
        const bool beside = p.y() > top + kCornerMargin && p.y() < bottom - kCornerMargin;
        const bool above = p.x() > left + kCornerMargin && p.x() < right - kCornerMargin;
        double nearest = tolerance;
        for (int side = 0; side < 4; ++side) {
            if (!(side < 2 ? beside : above) || std::abs(across[side]) > nearest) continue;
            nearest = std::abs(across[side]);
            hit.side = static_cast<int>(4 * h) + side;
            hit.across = across[side];
            hit.along = side < 2 ? p.y() - top : p.x() - left;
            hit.length = side < 2 ? bottom - top : right - left;
        }
        hit.in_hole = hit.side < 0 && across[0] > tolerance && across[1] < -tolerance &&
                      across[2] > tolerance && across[3] < -tolerance;
        return hit;  // holes do not overlap, not even enlarged: their gap is wider than that
    }
    return hit;
}

}  // namespace petal
