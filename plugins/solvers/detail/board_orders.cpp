// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "solvers/detail/board_orders.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "solvers/detail/assignment.hpp"
#include "solvers/detail/pose_starts.hpp"

namespace petal {
namespace {

constexpr int kSettleRounds = 6;

Eigen::Vector2d centre(const std::vector<Eigen::Vector2d>& corners) {
    Eigen::Vector2d sum = Eigen::Vector2d::Zero();
    for (const auto& corner : corners) sum += corner;
    return sum / static_cast<double>(corners.size());
}

Eigen::Vector3d centre(const std::vector<Eigen::Vector3d>& corners) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (const auto& corner : corners) sum += corner;
    return sum / static_cast<double>(corners.size());
}

/// The largest distance of a corner from the centre, px.
double radius(const std::vector<Eigen::Vector2d>& corners) {
    const Eigen::Vector2d middle = centre(corners);
    double largest = 0.0;
    for (const auto& corner : corners) largest = std::max(largest, (corner - middle).norm());
    return largest;
}

/// Whether an order has this minimum already: the same cost to many digits.
bool known_pose(const BoardOrder& order, const RefinedPose& pose) {
    return std::any_of(order.poses.begin(), order.poses.end(), [&](const RefinedPose& known) {
        return std::abs(known.cost - pose.cost) <= 1e-6 * (known.cost + 1e-9);
    });
}

bool by_rms(const BoardOrder& a, const BoardOrder& b) {
    return a.rms_px() < b.rms_px();
}

}  // namespace

BoardOrders::BoardOrders(const CameraModel& model, const std::vector<LidarBoard>& lidar,
                         std::vector<const ImageBoard*> image, GateParams gates,
                         std::function<void()> poll)
    : model_(model),
      lidar_(lidar),
      image_(std::move(image)),
      gates_(gates),
      poll_(std::move(poll)) {
    for (const LidarBoard& board : lidar_) rotations_.push_back(board_rotations(board.corners));
}

std::vector<PointPair> BoardOrders::pairs(const std::vector<BoardMatch>& matches) const {
    std::vector<PointPair> result;
    for (std::size_t m = 0; m < matches.size(); ++m) {
        const LidarBoard& lidar = lidar_[static_cast<std::size_t>(matches[m].lidar)];
        const ImageBoard& image = *image_[static_cast<std::size_t>(matches[m].image)];
        const CornerOrder& order = rotations_[static_cast<std::size_t>(matches[m].lidar)]
                                             [static_cast<std::size_t>(matches[m].rotation)];
        for (std::size_t i = 0; i < image.corners.size(); ++i) {
            PointPair pair;
            pair.lidar = lidar.corners[order[i]];
            pair.image = image.corners[i];
            if (i < image.covariance.size()) pair.covariance = image.covariance[i];
            pair.board = static_cast<int>(m);
            pair.corner = static_cast<int>(i);
            result.push_back(pair);
        }
    }
    return result;
}

bool BoardOrders::front_seen(const LidarBoard& board, const Eigen::Isometry3d& pose) const {
    // z of the board points into it, away from whoever sees its front.
    const Eigen::Vector3d into = pose.linear() * board.T_lidar_board.linear().col(2);
    return into.dot(pose * centre(board.corners)) > 0.0;
}

std::optional<std::vector<double>> BoardOrders::gate_ratios(const std::vector<BoardMatch>& matches,
                                                            const Eigen::Isometry3d& pose) const {
    std::vector<double> ratios;
    for (const BoardMatch& match : matches) {
        const LidarBoard& board = lidar_[static_cast<std::size_t>(match.lidar)];
        if (!front_seen(board, pose)) return std::nullopt;
        double squares = 0.0;
        const auto corners = pairs({match});
        for (const PointPair& pair : corners) {
            const auto pixel = model_.project(pose * pair.lidar);
            if (!pixel) return std::nullopt;
            squares += (pair.image - *pixel).squaredNorm();
        }
        const double rms = std::sqrt(squares / static_cast<double>(corners.size()));
        const double depth = (pose * centre(board.corners)).z();
        ratios.push_back(rms / std::max(gates_.gate * model_.fx() / depth, gates_.min_gate_px));
    }
    return ratios;
}

std::vector<BoardMatch> BoardOrders::explained(const Eigen::Isometry3d& pose) const {
    // Loosely, since one board alone places the others badly: a centre within one and a half radii,
    // and the rotation that then fits best about the centres.
    const double infinity = std::numeric_limits<double>::infinity();
    Eigen::MatrixXd cost =
        Eigen::MatrixXd::Constant(static_cast<Eigen::Index>(lidar_.size()),
                                  static_cast<Eigen::Index>(image_.size()), infinity);
    constexpr double kLooseRadii = 1.5;
    std::vector<std::vector<int>> rotation(lidar_.size(), std::vector<int>(image_.size(), 0));
    for (std::size_t l = 0; l < lidar_.size(); ++l) {
        if (!front_seen(lidar_[l], pose)) continue;
        std::vector<Eigen::Vector2d> projected;
        for (const auto& corner : lidar_[l].corners)
            if (const auto pixel = model_.project(pose * corner)) projected.push_back(*pixel);
        if (projected.size() != lidar_[l].corners.size()) continue;
        const Eigen::Vector2d middle = centre(projected);
        for (std::size_t b = 0; b < image_.size(); ++b) {
            const auto& corners = image_[b]->corners;
            if (corners.size() != projected.size() || image_[b]->target != lidar_[l].target)
                continue;
            const Eigen::Vector2d shift = centre(corners) - middle;
            const double distance = shift.norm() / radius(corners);
            if (distance > kLooseRadii) continue;
            cost(static_cast<Eigen::Index>(l), static_cast<Eigen::Index>(b)) = distance * distance;
            double least = infinity;
            for (std::size_t r = 0; r < rotations_[l].size(); ++r) {
                double squares = 0.0;
                for (std::size_t i = 0; i < corners.size(); ++i)
                    squares += (corners[i] - shift - projected[rotations_[l][r][i]]).squaredNorm();
                if (squares >= least) continue;
                least = squares;
                rotation[l][b] = static_cast<int>(r);
            }
        }
    }
    const auto columns = assign(cost, kLooseRadii * kLooseRadii);
    std::vector<BoardMatch> matches;
    for (std::size_t l = 0; l < columns.size(); ++l)
        if (columns[l] >= 0)
            matches.push_back({static_cast<int>(l), columns[l],
                               rotation[l][static_cast<std::size_t>(columns[l])]});
    return matches;
}

std::optional<BoardOrder> BoardOrders::refined(const std::vector<BoardMatch>& matches,
                                               const std::vector<Eigen::Isometry3d>& starts) const {
    if (poll_) poll_();
    // Plain pixels: orders are compared by what they leave, not by how they are weighed.
    const ReprojectionProblem problem(model_, pairs(matches), false);
    BoardOrder order;
    order.matches = matches;
    for (const RefinedPose& pose : problem.refine_all(starts)) {
        const auto ratios = gate_ratios(matches, pose.T_camera_lidar);
        if (!ratios) continue;
        if (order.poses.empty())
            order.worst_gate_ratio = *std::max_element(ratios->begin(), ratios->end());
        order.poses.push_back(pose);
    }
    if (order.poses.empty()) return std::nullopt;
    return order;
}

void BoardOrders::add(BoardOrder order, std::vector<BoardOrder>& found) const {
    for (BoardOrder& known : found) {
        if (!(known.matches == order.matches)) continue;
        if (known_pose(known, order.poses.front())) return;
        std::vector<Eigen::Isometry3d> poses;
        for (const auto* one : {&known, &order})
            for (const auto& pose : one->poses) poses.push_back(pose.T_camera_lidar);
        if (auto joined = refined(known.matches, poses)) known = std::move(*joined);
        return;
    }
    found.push_back(std::move(order));
}

void BoardOrders::settle(const std::vector<BoardMatch>& matches, const Eigen::Isometry3d& start,
                         std::vector<BoardOrder>& found) const {
    auto order = refined(matches, {start});
    for (int round = 0; order; ++round) {
        const Eigen::Isometry3d pose = order->poses.front().T_camera_lidar;
        const auto next = explained(pose);
        const bool settled = next.empty() || next == order->matches || round == kSettleRounds;
        add(std::move(*order), found);
        if (settled) return;
        order = refined(next, {pose});
    }
}

std::optional<BoardOrder> BoardOrders::reduced(BoardOrder order, std::size_t count) const {
    while (order.matches.size() > count) {
        const auto ratios = gate_ratios(order.matches, order.poses.front().T_camera_lidar);
        if (!ratios) return std::nullopt;
        const auto worst = std::max_element(ratios->begin(), ratios->end()) - ratios->begin();
        order.matches.erase(order.matches.begin() + worst);
        if (order.matches.empty()) return std::nullopt;
        std::vector<Eigen::Isometry3d> starts;
        for (const auto& pose : order.poses) starts.push_back(pose.T_camera_lidar);
        auto smaller = refined(order.matches, starts);
        if (!smaller) return std::nullopt;
        order = std::move(*smaller);
    }
    return order;
}

std::vector<BoardOrder> BoardOrders::kin(const BoardOrder& order) const {
    std::vector<BoardOrder> found;
    const auto try_one = [&](const std::vector<BoardMatch>& matches) {
        if (auto other = refined(matches, pnp_poses("sqpnp", model_, pairs(matches))))
            found.push_back(std::move(*other));
    };
    const auto rotations_of = [&](const BoardMatch& match) {
        return static_cast<int>(rotations_[static_cast<std::size_t>(match.lidar)].size());
    };
    for (std::size_t m = 0; m < order.matches.size(); ++m) {
        for (int r = 0; r < rotations_of(order.matches[m]); ++r) {
            if (r == order.matches[m].rotation) continue;
            auto matches = order.matches;
            matches[m].rotation = r;
            try_one(matches);
        }
        for (std::size_t n = m + 1; n < order.matches.size(); ++n) {
            auto swapped = order.matches;
            std::swap(swapped[m].image, swapped[n].image);
            const int rotations = std::min(rotations_of(swapped[m]), rotations_of(swapped[n]));
            for (int r = 0; r < rotations; ++r) {  // a twin is rolled as a whole
                for (BoardMatch& match : swapped)
                    match.rotation = std::min(r, rotations_of(match) - 1);
                try_one(swapped);
            }
        }
    }
    return found;
}

bool BoardOrders::alike(std::size_t lidar, std::size_t image) const {
    return lidar_[lidar].target == image_[image]->target &&
           lidar_[lidar].corners.size() == image_[image]->corners.size();
}

void BoardOrders::search_single_boards(std::vector<BoardOrder>& found) const {
    for (std::size_t l = 0; l < lidar_.size(); ++l)
        for (std::size_t b = 0; b < image_.size(); ++b) {
            if (!alike(l, b)) continue;
            for (std::size_t r = 0; r < rotations_[l].size(); ++r) {
                const std::vector<BoardMatch> seed{
                    {static_cast<int>(l), static_cast<int>(b), static_cast<int>(r)}};
                for (const auto& start : planar_poses(model_, pairs(seed)))
                    settle(seed, start, found);
            }
        }
}

std::optional<Eigen::Vector3d> BoardOrders::centre_seen(std::size_t lidar,
                                                        std::size_t image) const {
    if (!alike(lidar, image)) return std::nullopt;
    const auto poses =
        planar_poses(model_, pairs({{static_cast<int>(lidar), static_cast<int>(image), 0}}));
    if (poses.empty()) return std::nullopt;
    return poses.front() * centre(lidar_[lidar].corners);
}

void BoardOrders::search_board_pairs(std::vector<BoardOrder>& found) const {
    // One board can place another many board widths off, so that neither the right order nor its
    // twin is reached from single boards alone.
    constexpr double kHopeless = 2.0;  // gates; what SQPNP may miss by before it is refined
    // The distance of two centres is the same for both sensors, up to the error of their depths.
    constexpr double kDepthError = 0.1;
    std::vector<std::vector<std::optional<Eigen::Vector3d>>> seen(lidar_.size());
    for (std::size_t l = 0; l < lidar_.size(); ++l)
        for (std::size_t b = 0; b < image_.size(); ++b) seen[l].push_back(centre_seen(l, b));
    for (std::size_t l = 0; l < lidar_.size(); ++l)
        for (std::size_t l2 = l + 1; l2 < lidar_.size(); ++l2)
            for (std::size_t b = 0; b < image_.size(); ++b)
                for (std::size_t b2 = 0; b2 < image_.size(); ++b2) {
                    if (b == b2 || !seen[l][b] || !seen[l2][b2]) continue;
                    const double apart =
                        (centre(lidar_[l].corners) - centre(lidar_[l2].corners)).norm();
                    if (std::abs((*seen[l][b] - *seen[l2][b2]).norm() - apart) >
                        kDepthError * (seen[l][b]->norm() + seen[l2][b2]->norm()))
                        continue;
                    for (std::size_t r = 0; r < rotations_[l].size(); ++r)
                        for (std::size_t r2 = 0; r2 < rotations_[l2].size(); ++r2) {
                            const std::vector<BoardMatch> seed{
                                {static_cast<int>(l), static_cast<int>(b), static_cast<int>(r)},
                                {static_cast<int>(l2), static_cast<int>(b2), static_cast<int>(r2)}};
                            for (const auto& start : pnp_poses("sqpnp", model_, pairs(seed))) {
                                const auto ratios = gate_ratios(seed, start);
                                if (!ratios || std::max((*ratios)[0], (*ratios)[1]) > kHopeless)
                                    continue;
                                settle(seed, start, found);
                            }
                        }
                }
}

std::vector<BoardOrder> BoardOrders::search() const {
    std::vector<BoardOrder> found;
    search_single_boards(found);
    search_board_pairs(found);
    std::stable_sort(found.begin(), found.end(), by_rms);
    return found;
}

}  // namespace petal
