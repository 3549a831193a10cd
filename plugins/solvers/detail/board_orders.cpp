// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "solvers/detail/board_orders.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "petal/calibration/se3.hpp"
#include "solvers/detail/pixel_fit.hpp"
#include "solvers/detail/pose_hypotheses.hpp"
#include "solvers/detail/pose_starts.hpp"

namespace petal {
namespace {

constexpr int kSettleRounds = 6;
constexpr std::size_t kMostSettled = 160;  // hypotheses; the most promising come first

/// Whether an order has this minimum already.
bool known_pose(const BoardOrder& order, const RefinedPose& pose) {
    return std::any_of(order.poses.begin(), order.poses.end(), [&](const RefinedPose& known) {
        const Eigen::Isometry3d between = pose.T_camera_lidar * known.T_camera_lidar.inverse();
        return between.translation().norm() < 1e-3 && rotation_angle(between.linear()) < 1e-3;
    });
}

const BoardOrder* find_order(const std::vector<BoardOrder>& found,
                             const std::vector<BoardMatch>& matches) {
    for (const BoardOrder& order : found)
        if (order.matches == matches) return &order;
    return nullptr;
}

}  // namespace

BoardOrders::BoardOrders(const BoardSet& boards, std::function<void()> poll)
    : boards_(boards), poll_(std::move(poll)) {
    if (!poll_) poll_ = [] {};
}

bool BoardOrders::weigh(BoardOrder& order) const {
    const auto ratios = boards_.gate_ratios(order.matches, order.poses.front().T_camera_lidar);
    if (!ratios) return false;
    order.worst_gate_ratio = *std::max_element(ratios->begin(), ratios->end());
    order.within_gate = static_cast<std::size_t>(
        std::count_if(ratios->begin(), ratios->end(), [](double ratio) { return ratio <= 1.0; }));
    return true;
}

std::optional<BoardOrder> BoardOrders::refined(const std::vector<BoardMatch>& matches,
                                               const std::vector<Eigen::Isometry3d>& starts) const {
    poll_();
    if (matches.empty()) return std::nullopt;
    // Plain pixels: orders are compared by what they leave, not by how they are weighed.
    const auto pairs = boards_.pairs(matches);
    BoardOrder order;
    order.matches = matches;
    for (const Eigen::Isometry3d& start : starts) {
        const auto fit = fit_pixels(boards_.model(), pairs, start);
        if (fit && !known_pose(order, fit->pose) &&
            boards_.gate_ratios(matches, fit->pose.T_camera_lidar))
            order.poses.push_back(fit->pose);
    }
    if (order.poses.empty()) return std::nullopt;
    std::stable_sort(order.poses.begin(), order.poses.end(),
                     [](const RefinedPose& a, const RefinedPose& b) { return a.cost < b.cost; });
    if (!weigh(order)) return std::nullopt;
    return order;
}

void BoardOrders::add(BoardOrder order, std::vector<BoardOrder>& found) const {
    for (BoardOrder& known : found) {
        if (!(known.matches == order.matches)) continue;
        for (const RefinedPose& pose : order.poses) {
            if (known_pose(known, pose)) continue;
            const auto at = std::upper_bound(
                known.poses.begin(), known.poses.end(), pose,
                [](const RefinedPose& a, const RefinedPose& b) { return a.cost < b.cost; });
            known.poses.insert(at, pose);
        }
        weigh(known);
        return;
    }
    found.push_back(std::move(order));
}

void BoardOrders::settle(const std::vector<BoardMatch>& matches, const Eigen::Isometry3d& start,
                         std::vector<BoardOrder>& found) const {
    auto next = matches;
    Eigen::Isometry3d pose = start;
    for (int round = 0; round <= kSettleRounds && !next.empty(); ++round) {
        // From near one of its minima it would lead there again, and on from there as before.
        if (const BoardOrder* known = find_order(found, next))
            if (std::any_of(known->poses.begin(), known->poses.end(), [&](const auto& minimum) {
                    return near_pose(minimum.T_camera_lidar, pose);
                }))
                return;
        auto order = refined(next, {pose});
        if (!order) return;
        pose = order->poses.front().T_camera_lidar;
        auto explained = boards_.explained(pose).matches;
        const bool settled = explained == order->matches;
        add(std::move(*order), found);
        if (settled) return;
        next = std::move(explained);
    }
}

std::vector<BoardOrder> BoardOrders::search() const {
    std::vector<BoardOrder> found;
    const auto hypotheses = pose_hypotheses(boards_, poll_);
    for (std::size_t i = 0; i < hypotheses.size() && i < kMostSettled; ++i)
        settle(hypotheses[i].explained.matches, hypotheses[i].pose, found);
    std::stable_sort(found.begin(), found.end(), [](const BoardOrder& a, const BoardOrder& b) {
        return a.within_gate != b.within_gate ? a.within_gate > b.within_gate
                                              : a.rms_px() < b.rms_px();
    });
    return found;
}

std::optional<BoardOrder> BoardOrders::reduced(BoardOrder order, std::size_t count) const {
    while (order.matches.size() > count) {
        const auto ratios = boards_.gate_ratios(order.matches, order.poses.front().T_camera_lidar);
        if (!ratios) return std::nullopt;
        const auto worst = std::max_element(ratios->begin(), ratios->end()) - ratios->begin();
        order.matches.erase(order.matches.begin() + worst);
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
    const auto try_one = [&](const std::vector<BoardMatch>& matches,
                             const std::vector<Eigen::Isometry3d>& starts) {
        if (auto other = refined(matches, starts)) add(std::move(*other), found);
    };
    const auto rotations_of = [&](const BoardMatch& match) {
        return static_cast<int>(boards_.lidar(match).rotations.size());
    };
    const Eigen::Isometry3d& pose = order.poses.front().T_camera_lidar;
    for (std::size_t m = 0; m < order.matches.size(); ++m) {
        const BoardMatch& one = order.matches[m];
        const auto& turns = boards_.lidar(one).turns;
        for (int r = 0; r < rotations_of(one); ++r) {
            if (r == one.rotation) continue;
            auto matches = order.matches;
            matches[m].rotation = r;
            // From the pose that keeps this board where it is seen.
            const Eigen::Isometry3d rolled = pose * turns[static_cast<std::size_t>(one.rotation)] *
                                             turns[static_cast<std::size_t>(r)].inverse();
            try_one(matches, {rolled, pose});
            const int parts = rotations_of(one);
            const int by = (r - one.rotation + parts) % parts;
            for (BoardMatch& match : matches)
                if (rotations_of(match) == parts && &match != &matches[m])
                    match.rotation = (match.rotation + by) % parts;
            try_one(matches, {rolled, pose});
        }
        for (std::size_t n = m + 1; n < order.matches.size(); ++n) {
            if (!boards_.alike(static_cast<std::size_t>(one.lidar),
                               static_cast<std::size_t>(order.matches[n].image)) ||
                !boards_.alike(static_cast<std::size_t>(order.matches[n].lidar),
                               static_cast<std::size_t>(one.image)))
                continue;
            auto swapped = order.matches;
            std::swap(swapped[m].image, swapped[n].image);
            const int parts = std::min(rotations_of(swapped[m]), rotations_of(swapped[n]));
            for (int by = 0; by < parts; ++by) {  // a twin is rolled as a whole
                for (std::size_t k = 0; k < swapped.size(); ++k)
                    swapped[k].rotation =
                        (order.matches[k].rotation + by) % rotations_of(swapped[k]);
                try_one(swapped, pnp_poses("sqpnp", boards_.model(), boards_.pairs(swapped)));
            }
        }
    }
    return found;
}

}  // namespace petal
