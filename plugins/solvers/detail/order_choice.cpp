// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "solvers/detail/order_choice.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "petal/calibration/angles.hpp"
#include "petal/printed.hpp"

namespace petal {
namespace {

constexpr double kBoardRedundancy = 4.0;  // 32 numbers a board come from about 8 lines

bool same(const BoardOrder& a, const BoardOrder& b) {
    return a.matches == b.matches;
}

void add_distinct(std::vector<BoardOrder>& orders, BoardOrder order) {
    for (BoardOrder& known : orders) {
        if (!same(known, order)) continue;
        if (order.rms_px() < known.rms_px()) known = std::move(order);
        return;
    }
    orders.push_back(std::move(order));
}

/// What remains of an order once the boards beyond their gate are gone.
std::optional<BoardOrder> within_gate(const BoardOrders& boards, const BoardOrder& order) {
    std::optional<BoardOrder> kept = order;
    while (kept && kept->worst_gate_ratio > 1.0)
        kept = boards.reduced(std::move(*kept), kept->matches.size() - 1);
    return kept;
}

bool priors_hold(const Eigen::Isometry3d& pose, const OrderParams& params) {
    if (params.upright) {
        // LiDAR +z seen by the camera, whose up is -y.
        const double cosine = std::clamp(-pose.linear()(1, 2), -1.0, 1.0);
        if (std::acos(cosine) * kDegrees > params.upright_tolerance_deg) return false;
    }
    return !params.use_max_baseline || pose.translation().norm() <= params.max_baseline;
}

/// The order with the poses that the priors allow first; none where they allow none.
std::optional<BoardOrder> allowed(BoardOrder order, const OrderParams& params) {
    const auto split = std::stable_partition(
        order.poses.begin(), order.poses.end(),
        [&](const RefinedPose& pose) { return priors_hold(pose.T_camera_lidar, params); });
    if (split == order.poses.begin()) return std::nullopt;
    return order;
}

std::string prior_names(const OrderParams& params) {
    std::string names;
    if (params.upright)
        names += printed("image up and LiDAR +z within %.0f deg", params.upright_tolerance_deg);
    if (params.use_max_baseline)
        names += (names.empty() ? "" : ", ") +
                 printed("sensors at most %.2f m apart", params.max_baseline);
    return names;
}

}  // namespace

std::optional<OrderChoice> choose_order(const BoardOrders& boards,
                                        const std::vector<BoardOrder>& found,
                                        const OrderParams& params) {
    std::size_t most = 0;
    std::vector<BoardOrder> accepted;
    for (const BoardOrder& order : found)
        if (auto kept = within_gate(boards, order)) {
            most = std::max(most, kept->matches.size());
            add_distinct(accepted, std::move(*kept));
        }
    if (most == 0) return std::nullopt;

    // Whoever explains as many boards, also beyond the gate: an order with fewer is no rival, since
    // it leaves a board without an explanation that another order has one for.
    std::vector<BoardOrder> rivals;
    for (BoardOrder& order : accepted)
        if (order.matches.size() == most) add_distinct(rivals, std::move(order));
    for (const BoardOrder& order : found)
        if (order.matches.size() >= most)
            if (auto cut = boards.reduced(order, most)) add_distinct(rivals, std::move(*cut));
    std::stable_sort(rivals.begin(), rivals.end(), [](const auto& a, const auto& b) {
        const bool a_in = a.worst_gate_ratio <= 1.0, b_in = b.worst_gate_ratio <= 1.0;
        return a_in != b_in ? a_in : a.rms_px() < b.rms_px();
    });

    const auto fill = [&](const BoardOrder& taken, DecidedBy by, std::string reason) {
        OrderChoice choice{taken, {}};
        choice.decision.by = by;
        // Of the pose that comes first, which a prior may have put before a better one.
        choice.decision.rms_px = taken.rms_px();
        const BoardOrder* other = nullptr;
        for (const BoardOrder& rival : rivals)
            if (!same(rival, taken) && (other == nullptr || rival.rms_px() < other->rms_px()))
                other = &rival;
        if (other != nullptr) {
            const auto corners = static_cast<double>(boards.pairs(taken.matches).size());
            // As compared with min_runner_up_ratio: with the floor.
            choice.decision.runner_up_rms_ratio = std::max(other->rms_px(), params.noise_floor_px) /
                                                  std::max(taken.rms_px(), params.noise_floor_px);
            choice.decision.runner_up_chi2 =
                corners * (std::pow(other->rms_px(), 2) - std::pow(taken.rms_px(), 2)) /
                kBoardRedundancy;
        }
        choice.decision.reason = std::move(reason);
        return choice;
    };

    const BoardOrder best = rivals.front();
    // The search may have passed over every rival; then the nearest kin of the order are rivals
    // enough.
    if (rivals.size() == 1)
        for (BoardOrder& kin : boards.kin(best)) add_distinct(rivals, std::move(kin));
    double runner_up = 0.0;
    for (const BoardOrder& rival : rivals)
        if (!same(rival, best) && (runner_up == 0.0 || rival.rms_px() < runner_up))
            runner_up = rival.rms_px();
    const double floored =
        std::max(runner_up, params.noise_floor_px) / std::max(best.rms_px(), params.noise_floor_px);
    // One board alone maps onto itself, exactly or nearly: whatever its residuals prefer is noise.
    const bool symmetric = most == 1;
    if (!symmetric && (runner_up == 0.0 || floored >= params.min_runner_up_ratio)) {
        const bool contradicts = !priors_hold(best.poses.front().T_camera_lidar, params);
        OrderChoice decided = fill(
            best, DecidedBy::data,
            (runner_up == 0.0 ? std::string("no other order explains as many boards")
                              : printed("the best other order has %.2f times the RMS", floored)) +
                (contradicts ? "; the priors (" + prior_names(params) + ") do not hold" : ""));
        decided.decision.contradicts_priors = contradicts;
        return decided;
    }

    const std::string alike =
        symmetric
            ? "one board looks the same in each of its rotations"
            : printed("the best other order has only %.2f times the RMS (%.2f against %.2f px)",
                      floored, runner_up, best.rms_px());
    if (!params.upright && !params.use_max_baseline)
        return fill(best, DecidedBy::undecided, alike + ", and no prior is on");

    std::vector<BoardOrder> left;
    const double limit = params.max_prior_ratio * std::max(best.rms_px(), params.noise_floor_px);
    for (const BoardOrder& rival : rivals)
        if (rival.worst_gate_ratio <= 1.0)
            if (auto order = allowed(rival, params))
                if (order->rms_px() <= limit) left.push_back(std::move(*order));
    std::stable_sort(left.begin(), left.end(),
                     [](const auto& a, const auto& b) { return a.rms_px() < b.rms_px(); });
    if (left.empty())
        return fill(
            best, DecidedBy::undecided,
            alike + ", and none of the orders satisfies the priors (" + prior_names(params) + ")");
    if (left.size() > 1) {
        const double ratio = std::max(left[1].rms_px(), params.noise_floor_px) /
                             std::max(left[0].rms_px(), params.noise_floor_px);
        if (ratio < params.min_runner_up_ratio)
            return fill(
                left[0], DecidedBy::undecided,
                alike + printed(", and %.0f orders satisfy the priors, the second with %.2f "
                                "times the RMS",
                                static_cast<double>(left.size()), ratio));
    }
    return fill(left[0], DecidedBy::prior,
                alike + "; taken: " + prior_names(params) +
                    printed(" (%.2f times the best RMS)",
                            std::max(left[0].rms_px(), params.noise_floor_px) /
                                std::max(best.rms_px(), params.noise_floor_px)));
}

}  // namespace petal
