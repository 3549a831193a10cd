// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "solvers/detail/order_choice.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "petal/calibration/angles.hpp"
#include "petal/printed.hpp"
#include "solvers/detail/order_chi2.hpp"
#include "solvers/detail/order_rivals.hpp"
#include "solvers/detail/verdict.hpp"

namespace petal {
namespace {

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

/// The rivals of one decision, with what is asked of each.
class Contest {
   public:
    Contest(const BoardSet& boards, std::vector<BoardOrder> rivals, const OrderParams& params)
        : boards_(boards), rivals_(std::move(rivals)), params_(params) {}

    OrderChoice decide() const;

   private:
    const BoardOrder& best() const { return rivals_.front(); }
    double floored(double rms_px) const { return std::max(rms_px, params_.noise_floor_px); }
    double ratio(const BoardOrder& a, const BoardOrder& b) const {
        return floored(a.rms_px()) / floored(b.rms_px());
    }
    std::optional<OrderChi2> chi2(const BoardOrder& order) const {
        return order_chi2(boards_, order.matches, order.poses.front().T_camera_lidar,
                          params_.lidar_sigma);
    }
    OrderChoice fill(const BoardOrder& taken, DecidedBy by, std::string reason) const;
    /// The rival whose chi-square comes nearest to that of `taken`: of those within their gates
    /// and the one with the least RMS, since the least RMS need not be the least chi-square.
    struct Nearest {
        const BoardOrder* order = nullptr;
        double more = 0.0;  ///< chi-square above that of `taken`
    };
    /// None where a chi-square cannot be told, or there is no rival.
    std::optional<Nearest> nearest(const BoardOrder& taken) const;
    /// What a chi-square above that of the best is in units of what the best leaves.
    static double surplus(const OrderChi2& mine, double more) {
        return more / std::max(1.0, mine.chi2 / std::max(1, mine.degrees_of_freedom));
    }
    /// More than noise is left, yet no other order comes near: then the detectors told too little
    /// noise, or one of many boards is false; the order is not in question.
    bool beyond_doubt(const OrderChi2& mine) const;
    /// Empty where the data decide for the best order, else why they do not.
    std::string why_not_data() const;
    OrderChoice by_data() const;
    OrderChoice by_prior(const std::string& alike) const;

    const BoardSet& boards_;
    std::vector<BoardOrder> rivals_;
    const OrderParams& params_;
};

OrderChoice Contest::fill(const BoardOrder& taken, DecidedBy by, std::string reason) const {
    OrderChoice choice{taken, {}};
    choice.decision.by = by;
    // Of the pose that comes first, which a prior may have put before a better one.
    choice.decision.rms_px = taken.rms_px();
    if (const BoardOrder* other = best_other(rivals_, taken)) {
        // As compared with min_runner_up_ratio: with the floor.
        choice.decision.runner_up_rms_ratio = ratio(*other, taken);
        // A pose explains the six numbers of one board exactly, whatever its order.
        if (taken.matches.size() > 1)
            if (const auto next = nearest(taken)) choice.decision.runner_up_chi2 = next->more;
    }
    choice.decision.reason = std::move(reason);
    return choice;
}

std::string Contest::why_not_data() const {
    // One board alone maps onto itself, exactly or nearly: whatever its residuals prefer is noise.
    if (best().matches.size() == 1) return "one board looks the same in each of its rotations";
    const auto mine = chi2(best());
    std::string untold = "a chi-square cannot be told (a covariance is none)";
    if (!mine) return untold;
    const BoardOrder* other = best_other(rivals_, best());
    if (other == nullptr) return "";
    const auto named = [&](const BoardOrder& order) {
        return "the best other order (" + difference_text(best(), order) + ")";
    };
    if (ratio(*other, best()) < params_.min_runner_up_ratio)
        return named(*other) + printed(" has only %.2f times the RMS (%.2f against %.2f px)",
                                       ratio(*other, best()), other->rms_px(), best().rms_px());
    const auto next = nearest(best());
    if (!next) return untold;
    const double more = surplus(*mine, next->more);
    if (more < params_.min_runner_up_chi2)
        return named(*next->order) + printed(" has a chi-square only %.1f above (%.1f asked for)",
                                             more, params_.min_runner_up_chi2);
    return "";
}

std::optional<Contest::Nearest> Contest::nearest(const BoardOrder& taken) const {
    const auto mine = chi2(taken);
    const BoardOrder* least_rms = best_other(rivals_, taken);
    if (!mine || least_rms == nullptr) return std::nullopt;
    Nearest found;
    for (const BoardOrder& rival : rivals_) {
        if (rival.matches == taken.matches || (&rival != least_rms && rival.worst_gate_ratio > 1.0))
            continue;
        const auto other = chi2(rival);
        if (!other) return std::nullopt;
        const double more = other->chi2 - mine->chi2;
        if (found.order == nullptr || more < found.more) found = {&rival, more};
    }
    return found;
}

bool Contest::beyond_doubt(const OrderChi2& mine) const {
    constexpr std::size_t kBoards = 4;  // of fewer a false one bends the pose instead of missing it
    constexpr double kSurplus = 1000.0;
    if (best().matches.size() < kBoards) return false;
    const auto next = nearest(best());
    return next && surplus(mine, next->more) >= kSurplus;
}

OrderChoice Contest::by_data() const {
    constexpr double kUpperZ = 3.0902;  // 99.9 %
    constexpr double kMisjudged = 2.0;  // chi-square a degree: sigmas told 1.4 times too small
    const BoardOrder* other = best_other(rivals_, best());
    std::string reason = other == nullptr ? std::string("no other order explains as many boards")
                                          : printed("the best other order has %.2f times the RMS",
                                                    ratio(*other, best()));
    // More than noise is left: then a board is false, or the sensors do not see the same ones, and
    // a smaller RMS than another order's proves nothing.
    const OrderChi2 mine = chi2(best()).value();  // told, or the data would not decide
    const double most = std::max(chi2_quantile(mine.degrees_of_freedom, kUpperZ),
                                 kMisjudged * mine.degrees_of_freedom);
    const bool contradicts = !priors_hold(best().poses.front().T_camera_lidar, params_);
    if (mine.chi2 > most) {
        const std::string noise = printed(
            "chi-square %.1f with %d degrees of freedom is more than "
            "noise",
            mine.chi2, mine.degrees_of_freedom);
        if (!beyond_doubt(mine)) {
            const bool prior = (params_.upright || params_.use_max_baseline) && !contradicts;
            return fill(best(), prior ? DecidedBy::prior : DecidedBy::undecided,
                        reason + "; but " + noise + ", so a board may be false or not shared" +
                            (prior ? "; the priors hold" : ""));
        }
        reason += "; " + noise + ", but no other order comes near";
    }
    if (contradicts) reason += "; the priors (" + prior_names(params_) + ") do not hold";
    OrderChoice decided = fill(best(), DecidedBy::data, std::move(reason));
    decided.decision.contradicts_priors = contradicts;
    return decided;
}

OrderChoice Contest::by_prior(const std::string& alike) const {
    if (!params_.upright && !params_.use_max_baseline)
        return fill(best(), DecidedBy::undecided, alike + ", and no prior is on");
    std::vector<BoardOrder> left;
    const double limit = params_.max_prior_ratio * floored(best().rms_px());
    for (const BoardOrder& rival : rivals_)
        if (rival.worst_gate_ratio <= 1.0)
            if (auto order = allowed(rival, params_))
                if (order->rms_px() <= limit) left.push_back(std::move(*order));
    std::stable_sort(left.begin(), left.end(),
                     [](const auto& a, const auto& b) { return a.rms_px() < b.rms_px(); });
    if (left.empty())
        return fill(
            best(), DecidedBy::undecided,
            alike + ", and none of the orders satisfies the priors (" + prior_names(params_) + ")");
    if (left.size() > 1 && ratio(left[1], left[0]) < params_.min_runner_up_ratio)
        return fill(left[0], DecidedBy::undecided,
                    alike + printed(", and %.0f orders satisfy the priors, the second with %.2f "
                                    "times the RMS",
                                    static_cast<double>(left.size()), ratio(left[1], left[0])));
    return fill(left[0], DecidedBy::prior,
                alike + "; taken: " + prior_names(params_) +
                    printed(" (%.2f times the best RMS)", ratio(left[0], best())));
}

OrderChoice Contest::decide() const {
    const std::string alike = why_not_data();
    return alike.empty() ? by_data() : by_prior(alike);
}

}  // namespace

std::optional<OrderChoice> choose_order(const BoardOrders& orders,
                                        const std::vector<BoardOrder>& found,
                                        const OrderParams& params) {
    auto rivals = order_rivals(orders, found);
    if (rivals.empty()) return std::nullopt;
    return Contest(orders.boards(), std::move(rivals), params).decide();
}

}  // namespace petal
