// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "solvers/detail/order_rivals.hpp"

#include <algorithm>
#include <optional>
#include <utility>

#include "petal/calibration/angles.hpp"
#include "petal/calibration/se3.hpp"
#include "petal/printed.hpp"

namespace petal {
namespace {

void add_distinct(std::vector<BoardOrder>& orders, BoardOrder order) {
    for (BoardOrder& known : orders) {
        if (!(known.matches == order.matches)) continue;
        if (order.rms_px() < known.rms_px()) known = std::move(order);
        return;
    }
    orders.push_back(std::move(order));
}

}  // namespace

std::vector<BoardOrder> order_rivals(const BoardOrders& orders,
                                     const std::vector<BoardOrder>& found) {
    std::size_t most = 0;
    std::vector<BoardOrder> accepted;
    for (const BoardOrder& order : found) {
        std::optional<BoardOrder> kept = order;
        while (kept && kept->worst_gate_ratio > 1.0) {
            const std::size_t fewer = kept->matches.size() - 1;
            if (fewer == 0 || fewer < most) {
                kept.reset();
            } else {
                kept = orders.reduced(std::move(*kept), fewer);
            }
        }
        if (!kept || kept->matches.size() < most) continue;
        most = kept->matches.size();
        add_distinct(accepted, std::move(*kept));
    }
    std::vector<BoardOrder> rivals;
    if (most == 0) return rivals;
    for (BoardOrder& order : accepted)
        if (order.matches.size() == most) add_distinct(rivals, std::move(order));
    for (const BoardOrder& order : found)
        if (order.matches.size() >= most)
            if (auto cut = orders.reduced(order, most)) add_distinct(rivals, std::move(*cut));
    std::stable_sort(rivals.begin(), rivals.end(), [](const auto& a, const auto& b) {
        const bool a_in = a.worst_gate_ratio <= 1.0, b_in = b.worst_gate_ratio <= 1.0;
        return a_in != b_in ? a_in : a.rms_px() < b.rms_px();
    });
    if (rivals.size() == 1)
        for (BoardOrder& kin : orders.kin(rivals.front())) add_distinct(rivals, std::move(kin));
    return rivals;
}

const BoardOrder* best_other(const std::vector<BoardOrder>& rivals, const BoardOrder& taken) {
    const BoardOrder* best = nullptr;
    for (const BoardOrder& rival : rivals)
        if (!(rival.matches == taken.matches) &&
            (best == nullptr || rival.rms_px() < best->rms_px()))
            best = &rival;
    return best;
}

std::string difference_text(const BoardOrder& taken, const BoardOrder& other) {
    const Eigen::Isometry3d between =
        other.poses.front().T_camera_lidar * taken.poses.front().T_camera_lidar.inverse();
    int swapped = 0;
    for (const BoardMatch& match : other.matches)
        for (const BoardMatch& mine : taken.matches)
            swapped += match.lidar == mine.lidar && match.image != mine.image ? 1 : 0;
    const double angle = rotation_angle(between.linear()) * kDegrees;
    std::string text = printed("turned by %.0f deg", angle);
    if (swapped > 0) text += printed(", %d boards swapped", swapped);
    return text;
}

}  // namespace petal
