// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "metrics/detail/board_edges.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "petal/calibration/polygon.hpp"
#include "petal/error.hpp"

namespace petal {
namespace {

constexpr double kFar = std::numeric_limits<double>::infinity();

double to_nearest_side(const Target& target, const Eigen::Vector2d& p) {
    double nearest = distance_to_polygon(target.outline, p);
    for (const auto& hole : target.holes) nearest = std::min(nearest, distance_to_polygon(hole, p));
    for (const Target::RoundHole& hole : target.round_holes)
        nearest = std::min(nearest, std::abs((p - hole.centre).norm() - hole.radius));
    return nearest;
}

bool on_plate(const Target& target, const Eigen::Vector2d& p) {
    if (!inside_polygon(target.outline, p)) return false;
    for (const auto& hole : target.holes)
        if (inside_polygon(hole, p)) return false;
    for (const Target::RoundHole& hole : target.round_holes)
        if ((p - hole.centre).norm() < hole.radius) return false;
    return true;
}

}  // namespace

const Target& TargetsByName::find(const std::string& name, Run& run) {
    if (!files_read_) {
        for (const auto& file : files_) {
            Target target = load_target(file);
            run.used_file(find_target_file(file));
            known_[target.name] = std::move(target);
        }
        files_read_ = true;
    }
    const auto found = known_.find(name);
    if (found != known_.end()) return found->second;
    try {
        Target target = load_target(name);
        run.used_file(find_target_file(name));
        return known_.emplace(name, std::move(target)).first->second;
    } catch (const Error& error) {
        throw Error("the data tell of a board '" + name + "' whose edges are not known: " +
                    error.what() + "; name its file in the parameter 'targets'");
    }
}

BoardEdges::BoardEdges(const std::vector<Truth::Board>& boards, TargetsByName& targets, Run& run) {
    for (const Truth::Board& board : boards)
        boards_.push_back({targets.find(board.target, run), board.T_lidar_board.inverse()});
}

double BoardEdges::distance(const Eigen::Vector3d& point) const {
    const Place found = place(point);
    return found.board < 0 ? kFar : found.edge;
}

BoardEdges::Place BoardEdges::place(const Eigen::Vector3d& point) const {
    Place found;
    double nearest_board = kFar;
    for (std::size_t i = 0; i < boards_.size(); ++i) {
        const Board& board = boards_[i];
        const Eigen::Vector3d p = board.T_board_lidar * point;
        const double to_side = to_nearest_side(board.target, p.head<2>());
        const double aside = on_plate(board.target, p.head<2>()) ? 0.0 : to_side;
        const double before = std::max({0.0, -p.z(), p.z() - board.target.thickness});
        const double to_board = std::hypot(aside, before);
        if (!p.allFinite() || to_board >= nearest_board) continue;
        nearest_board = to_board;
        found.board = static_cast<int>(i);
        found.edge = to_side;
        found.away =
            std::hypot(inside_polygon(board.target.outline, p.head<2>()) ? 0.0 : aside, before);
    }
    return found;
}

BoardEdges::HoleSide BoardEdges::nearest_hole_side(int index, const Eigen::Vector3d& point) const {
    const Board& board = boards_[static_cast<std::size_t>(index)];
    const Eigen::Vector2d p = (board.T_board_lidar * point).head<2>();
    HoleSide found{-1, kFar};
    int side = 0;
    for (const auto& hole : board.target.holes)
        for (std::size_t i = 0; i < hole.size(); ++i, ++side) {
            const Eigen::Vector2d d = hole[(i + 1) % hole.size()] - hole[i];
            const double t = std::clamp((p - hole[i]).dot(d) / d.squaredNorm(), 0.0, 1.0);
            const double distance = (hole[i] + t * d - p).norm();
            if (distance >= found.distance) continue;
            found = {side, distance};
        }
    return found;
}

int BoardEdges::hole_sides(int board) const {
    int sides = 0;
    for (const auto& hole : boards_[static_cast<std::size_t>(board)].target.holes)
        sides += static_cast<int>(hole.size());
    return sides;
}

}  // namespace petal
