// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <string>
#include <vector>

#include "solvers/detail/board_orders.hpp"

namespace petal {

/// The orders that compete, the best first: those within their gates by RMS, then the others. Every
/// one explains as many boards over all scenes as the best, also beyond the gate: an order with
/// fewer is no rival, since it leaves a board without an explanation that another order has one
/// for. Where the search passed over every rival, the nearest kin of the order are rivals enough.
/// Empty where no order explains a board within its gate.
std::vector<BoardOrder> order_rivals(const BoardOrders& orders,
                                     const std::vector<BoardOrder>& found);

/// The rival with the least RMS but `taken` itself; null where there is none.
const BoardOrder* best_other(const std::vector<BoardOrder>& rivals, const BoardOrder& taken);

/// What makes another order of one: "rolled by 180 deg, 2 boards swapped".
std::string difference_text(const BoardOrder& taken, const BoardOrder& other);

}  // namespace petal
