// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "solvers/detail/board_set.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "petal/calibration/angles.hpp"
#include "solvers/detail/assignment.hpp"

namespace petal {
namespace {

// Loosely, since one board alone places the others badly: a centre within one and a half radii,
// and the rotation that then fits best about the centres.
constexpr double kLooseRadii = 1.5;
/// A match that is off by so many radii counts half: among poses, one that explains some boards
/// well comes before one that explains more of them loosely, as posters invite to.
constexpr double kHalfRadii = 0.3;

double saturating(double square) {
    return square / (square + kHalfRadii * kHalfRadii);
}

template <class Point>
Point corner_mean(const std::vector<Point>& corners) {
    Point sum = Point::Zero();
    for (const auto& corner : corners) sum += corner;
    return sum / static_cast<double>(corners.size());
}

/// The rotations of a board by their angle about its z, each with the turn of the LiDAR frame about
/// its centre and z that puts corner i where corner order[i] is: a whole part of a full turn. What
/// finds the rotations knows the board's plane, but neither its side nor its axes.
std::vector<std::pair<CornerOrder, Eigen::Isometry3d>> ordered_turns(
    const LidarBoard& board, const std::vector<CornerOrder>& rotations) {
    const Eigen::Isometry3d T_board_lidar = board.T_lidar_board.inverse();
    std::vector<Eigen::Vector3d> flat;
    flat.reserve(board.corners.size());
    for (const auto& corner : board.corners) flat.push_back(T_board_lidar * corner);
    const Eigen::Vector3d centre = corner_mean(flat);
    const int parts = static_cast<int>(rotations.size());
    const double part = 2.0 * kPi / parts;
    std::vector<std::pair<int, CornerOrder>> by_part;
    for (const CornerOrder& order : rotations) {
        double sine = 0.0, cosine = 0.0;
        for (std::size_t i = 0; i < flat.size(); ++i) {
            const Eigen::Vector2d from = (flat[i] - centre).head<2>();
            const Eigen::Vector2d to = (flat[order[i]] - centre).head<2>();
            sine += from.x() * to.y() - from.y() * to.x();
            cosine += from.dot(to);
        }
        const int turned = static_cast<int>(std::lround(std::atan2(sine, cosine) / part));
        by_part.emplace_back((turned + parts) % parts, order);
    }
    std::stable_sort(by_part.begin(), by_part.end(),
                     [](const auto& a, const auto& b) { return a.first < b.first; });
    std::vector<std::pair<CornerOrder, Eigen::Isometry3d>> result;
    for (auto& [turned, order] : by_part) {
        Eigen::Isometry3d turn = Eigen::Isometry3d::Identity();
        turn.linear() =
            Eigen::AngleAxisd(part * turned, Eigen::Vector3d::UnitZ()).toRotationMatrix();
        turn.translation() = centre - turn.linear() * centre;
        result.emplace_back(std::move(order), board.T_lidar_board * turn * T_board_lidar);
    }
    return result;
}

}  // namespace

void BoardSet::add_scene(const LidarBoards* lidar, const ImageBoards& images,
                         const std::vector<int>& image) {
    Scene scene;
    for (std::size_t i = 0; lidar != nullptr && i < lidar->boards.size(); ++i) {
        const LidarBoard& board = lidar->boards[i];
        FromLidar seen;
        seen.scene = scenes_.size();
        seen.index = static_cast<int>(i);
        seen.board = &board;
        for (auto& [order, turn] : ordered_turns(board, board_rotations(board.corners))) {
            seen.rotations.push_back(std::move(order));
            seen.turns.push_back(turn);
        }
        seen.centre = corner_mean(board.corners);
        scene.lidar.push_back(lidar_.size());
        lidar_.push_back(std::move(seen));
    }
    for (const int i : image) {
        FromImage seen;
        seen.scene = scenes_.size();
        seen.index = i;
        seen.board = &images.boards[static_cast<std::size_t>(i)];
        seen.centre = corner_mean(seen.board->corners);
        for (const auto& corner : seen.board->corners)
            seen.radius = std::max(seen.radius, (corner - seen.centre).norm());
        scene.image.push_back(image_.size());
        image_.push_back(seen);
    }
    scenes_.push_back(std::move(scene));
}

bool BoardSet::alike(std::size_t lidar, std::size_t image) const {
    const FromLidar& one = lidar_[lidar];
    const FromImage& other = image_[image];
    return one.scene == other.scene && one.board->target == other.board->target &&
           one.board->corners.size() == other.board->corners.size();
}

std::vector<PointPair> BoardSet::pairs(const std::vector<BoardMatch>& matches) const {
    std::vector<PointPair> result;
    for (std::size_t m = 0; m < matches.size(); ++m) {
        const FromLidar& seen = lidar(matches[m]);
        const ImageBoard& in_image = *image(matches[m]).board;
        const CornerOrder& order = seen.rotations[static_cast<std::size_t>(matches[m].rotation)];
        for (std::size_t i = 0; i < in_image.corners.size(); ++i) {
            PointPair pair;
            pair.lidar = seen.board->corners[order[i]];
            pair.image = in_image.corners[i];
            if (i < in_image.covariance.size()) pair.covariance = in_image.covariance[i];
            pair.board = static_cast<int>(m);
            pair.corner = static_cast<int>(i);
            result.push_back(pair);
        }
    }
    return result;
}

Eigen::Isometry3d BoardSet::T_lidar_board(const BoardMatch& match) const {
    const FromLidar& seen = lidar(match);
    Eigen::Isometry3d turned =
        seen.turns[static_cast<std::size_t>(match.rotation)] * seen.board->T_lidar_board;
    turned.linear() = Eigen::Quaterniond(turned.linear()).normalized().toRotationMatrix();
    return turned;
}

bool BoardSet::front_seen(const FromLidar& board, const Eigen::Isometry3d& pose) const {
    // z of the board points into it, away from whoever sees its front.
    const Eigen::Vector3d into = pose.linear() * board.board->T_lidar_board.linear().col(2);
    return into.dot(pose * board.centre) > 0.0;
}

double BoardSet::gate_px(const FromLidar& board, const Eigen::Isometry3d& pose) const {
    const double depth = (pose * board.centre).z();
    return std::max(gates_.gate * model_.fx() / depth, gates_.min_gate_px);
}

std::optional<std::vector<double>> BoardSet::gate_ratios(const std::vector<BoardMatch>& matches,
                                                         const Eigen::Isometry3d& pose) const {
    std::vector<double> ratios;
    for (const BoardMatch& match : matches) {
        const FromLidar& seen = lidar(match);
        if (!front_seen(seen, pose)) return std::nullopt;
        const auto& corners = image(match).board->corners;
        const CornerOrder& order = seen.rotations[static_cast<std::size_t>(match.rotation)];
        double squares = 0.0;
        for (std::size_t i = 0; i < corners.size(); ++i) {
            const auto pixel = model_.project(pose * seen.board->corners[order[i]]);
            if (!pixel) return std::nullopt;
            squares += (corners[i] - *pixel).squaredNorm();
        }
        const double rms = std::sqrt(squares / static_cast<double>(corners.size()));
        ratios.push_back(rms / gate_px(seen, pose));
    }
    return ratios;
}

BoardSet::Explained BoardSet::explained(const Eigen::Isometry3d& pose) const {
    const double infinity = std::numeric_limits<double>::infinity();
    Explained result;
    for (const Scene& scene : scenes_) {
        if (scene.lidar.empty()) continue;
        Eigen::MatrixXd cost =
            Eigen::MatrixXd::Constant(static_cast<Eigen::Index>(scene.lidar.size()),
                                      static_cast<Eigen::Index>(scene.image.size()), infinity);
        Eigen::MatrixXd shape = cost;  // what is left about the centres
        std::vector<std::vector<int>> rotation(scene.lidar.size(),
                                               std::vector<int>(scene.image.size(), 0));
        for (std::size_t l = 0; l < scene.lidar.size(); ++l) {
            const FromLidar& seen = lidar_[scene.lidar[l]];
            if (!front_seen(seen, pose)) continue;
            std::vector<Eigen::Vector2d> projected;
            projected.reserve(seen.board->corners.size());
            for (const auto& corner : seen.board->corners) {
                const auto pixel = model_.project(pose * corner);
                if (!pixel) break;
                projected.push_back(*pixel);
            }
            if (projected.size() != seen.board->corners.size()) continue;
            const Eigen::Vector2d middle = corner_mean(projected);
            for (std::size_t b = 0; b < scene.image.size(); ++b) {
                if (!alike(scene.lidar[l], scene.image[b])) continue;
                const FromImage& other = image_[scene.image[b]];
                const Eigen::Vector2d shift = other.centre - middle;
                const double distance = shift.norm() / other.radius;
                if (!(distance <= kLooseRadii)) continue;
                cost(static_cast<Eigen::Index>(l), static_cast<Eigen::Index>(b)) =
                    distance * distance;
                double least = infinity;
                for (std::size_t r = 0; r < seen.rotations.size(); ++r) {
                    double squares = 0.0;
                    for (std::size_t i = 0; i < projected.size(); ++i)
                        squares +=
                            (other.board->corners[i] - shift - projected[seen.rotations[r][i]])
                                .squaredNorm();
                    if (squares >= least) continue;
                    least = squares;
                    rotation[l][b] = static_cast<int>(r);
                }
                shape(static_cast<Eigen::Index>(l), static_cast<Eigen::Index>(b)) =
                    least / (static_cast<double>(projected.size()) * other.radius * other.radius);
            }
        }
        const auto columns = assign(cost, kLooseRadii * kLooseRadii);
        for (std::size_t l = 0; l < columns.size(); ++l) {
            if (columns[l] < 0) {
                result.misfit += 1.0;
                continue;
            }
            const auto b = static_cast<std::size_t>(columns[l]);
            const auto row = static_cast<Eigen::Index>(l);
            result.misfit += saturating(cost(row, columns[l]) + shape(row, columns[l]));
            result.matches.push_back({static_cast<int>(scene.lidar[l]),
                                      static_cast<int>(scene.image[b]), rotation[l][b]});
        }
    }
    return result;
}

}  // namespace petal
