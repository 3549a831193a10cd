// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <optional>
#include <string>
#include <vector>

#include "petal/calibration/correspondences.hpp"
#include "solvers/detail/board_orders.hpp"

namespace petal {

/// When the data decide, and what decides otherwise.
struct OrderParams {
    double min_runner_up_ratio = 1.5;
    double min_runner_up_chi2 = 20.0;
    double noise_floor_px = 0.3;
    double lidar_sigma = 0.005;  ///< m
    double max_prior_ratio = 3.0;
    bool upright = true;
    double upright_tolerance_deg = 45.0;
    bool use_max_baseline = true;
    double max_baseline = 1.0;  ///< m
};

struct OrderChoice {
    BoardOrder order;
    OrderDecision decision;
};

/// The most boards within their gate over all scenes; among the orders that explain as many: the
/// data, else the priors. None where no order explains a board within its gate.
std::optional<OrderChoice> choose_order(const BoardOrders& orders,
                                        const std::vector<BoardOrder>& found,
                                        const OrderParams& params);

}  // namespace petal
