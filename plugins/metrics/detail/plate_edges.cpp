// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "metrics/detail/plate_edges.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "petal/calibration/polygon.hpp"

namespace petal {
namespace {

/// Right, lower, left, upper: the quarters of a round hole.
const std::array<Eigen::Vector2d, 4>& quarters() {
    static const std::array<Eigen::Vector2d, 4> directions = {
        Eigen::Vector2d{1.0, 0.0}, Eigen::Vector2d{0.0, 1.0}, Eigen::Vector2d{-1.0, 0.0},
        Eigen::Vector2d{0.0, -1.0}};
    return directions;
}

std::size_t quarter_of(const Eigen::Vector2d& away) {
    const bool flat = std::abs(away.x()) >= std::abs(away.y());
    if (flat) return away.x() >= 0.0 ? 0 : 2;
    return away.y() >= 0.0 ? 1 : 3;
}

}  // namespace

PlateEdges::PlateEdges(const Target& target) : width_(target.width()), height_(target.height()) {
    add_ring(target.outline, false);
    for (const auto& hole : target.holes) add_ring(hole, true);
    grid_ = PlateSideGrid(rings_);
    for (const Target::RoundHole& hole : target.round_holes) {
        rounds_.push_back({hole.centre, hole.radius, edges_.size()});
        for (const Eigen::Vector2d& away : quarters())
            edges_.push_back({hole.centre + hole.radius * away, away, false});
    }
}

void PlateEdges::add_ring(std::vector<Eigen::Vector2d> corners, bool hole) {
    PlateRing ring{std::move(corners), hole, edges_.size()};
    for (std::size_t i = 0; i < ring.corners.size(); ++i) {
        const Eigen::Vector2d& a = ring.corners[i];
        const Eigen::Vector2d& b = ring.corners[(i + 1) % ring.corners.size()];
        const Eigen::Vector2d along = (b - a).normalized();
        Edge edge{0.5 * (a + b), {-along.y(), along.x()}, !hole};
        // On which side the plate lies is asked beside the edge: files list corners either way.
        const Eigen::Vector2d beside = edge.middle + 1e-4 * edge.inward;
        if (inside_polygon(ring.corners, beside) == hole) edge.inward = -edge.inward;
        edges_.push_back(edge);
    }
    rings_.push_back(std::move(ring));
}

std::optional<PlateEdges::Place> PlateEdges::near(const Eigen::Vector2d& p, double band,
                                                  double from_corner) const {
    std::optional<Place> best;
    double nearest = band;
    bool beside = false;
    for (const std::size_t i : grid_.at(p).sides) {
        const PlateSide& side = grid_.sides()[i];
        const double length = side.along.norm();
        const double along = (p - side.begin).dot(side.along) / length;
        const Eigen::Vector2d foot =
            side.begin + side.along * (std::clamp(along, 0.0, length) / length);
        const double distance = (p - foot).norm();
        if (distance >= nearest) continue;
        nearest = distance;
        beside = along >= from_corner && along <= length - from_corner;
        const Edge& edge = edges_[side.edge];
        best = Place{side.edge, edge.inward.dot(p - edge.middle), edge.inward};
    }
    for (const Round& round : rounds_) {
        const Eigen::Vector2d away = p - round.centre;
        const double distance = std::abs(away.norm() - round.radius);
        if (distance >= nearest || away.norm() < 1e-6) continue;
        nearest = distance;
        beside = true;
        best = Place{round.first_edge + quarter_of(away), away.norm() - round.radius,
                     away.normalized()};
    }
    if (!beside) return std::nullopt;
    return best;
}

double PlateEdges::inside(const Eigen::Vector2d& p) const {
    double nearest = std::numeric_limits<double>::infinity();
    const PlateSideGrid::Cell& cell = grid_.at(p);
    bool on_plate = cell.on_plate;
    for (const std::size_t i : cell.sides)
        nearest = std::min(nearest, distance_to(grid_.sides()[i], p));
    for (const std::size_t r : cell.rings)
        if (inside_polygon(rings_[r].corners, p) == rings_[r].hole) on_plate = false;
    for (const Round& round : rounds_) {
        const double outside = (p - round.centre).norm() - round.radius;
        nearest = std::min(nearest, std::abs(outside));
        if (outside < 0.0) on_plate = false;
    }
    return on_plate ? nearest : -nearest;
}

Target scaled(Target target, double scale) {
    for (Eigen::Vector2d& p : target.outline) p *= scale;
    for (auto& hole : target.holes)
        for (Eigen::Vector2d& p : hole) p *= scale;
    for (Target::RoundHole& hole : target.round_holes) {
        hole.centre *= scale;
        hole.radius *= scale;
    }
    target.markers.clear();
    target.checkerboards.clear();
    return target;
}

}  // namespace petal
