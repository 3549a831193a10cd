// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulation/scene/board_cut.hpp"

#include <Eigen/LU>
#include <cmath>
#include <cstddef>
#include <vector>

namespace petal::simulation {
namespace {

/// Sine of the angle between two sides: flatter corners are those of a curve, whose lines meet
/// nowhere certain.
constexpr double kLeastCorner = 0.3;

struct Side {
    Eigen::Vector2d normal;
    double offset;  ///< normal . p of its points
};

std::vector<Eigen::Vector2d> cut_polygon(const std::vector<Eigen::Vector2d>& polygon, double sigma,
                                         Engine& engine) {
    std::vector<Side> sides;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const Eigen::Vector2d along = polygon[(i + 1) % polygon.size()] - polygon[i];
        const Eigen::Vector2d outwards = Eigen::Vector2d(along.y(), -along.x()).normalized();
        sides.push_back({outwards, outwards.dot(polygon[i]) + normal(engine, sigma)});
    }
    std::vector<Eigen::Vector2d> cut;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const Side& before = sides[(i + sides.size() - 1) % sides.size()];
        const Side& after = sides[i];
        Eigen::Matrix2d lines;
        lines << before.normal.transpose(), after.normal.transpose();
        if (std::abs(lines.determinant()) > kLeastCorner)
            cut.emplace_back(lines.inverse() * Eigen::Vector2d(before.offset, after.offset));
        else
            cut.emplace_back(polygon[i] +
                             (after.offset - after.normal.dot(polygon[i])) * after.normal);
    }
    return cut;
}

}  // namespace

Target cut_board(const Target& target, double sigma, Engine& engine) {
    Target cut = target;
    if (sigma == 0.0) return cut;  // to the last bit
    cut.outline = cut_polygon(target.outline, sigma, engine);
    for (auto& hole : cut.holes) hole = cut_polygon(hole, sigma, engine);
    for (Target::RoundHole& hole : cut.round_holes) {
        hole.centre.x() += normal(engine, sigma);
        hole.centre.y() += normal(engine, sigma);
        hole.radius += normal(engine, sigma);
    }
    return cut;
}

}  // namespace petal::simulation
