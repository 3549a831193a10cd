// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <Eigen/Core>
#include <vector>

namespace petal {

/// For each row the column that it is given, -1 where none: every column at most once, the sum of
/// costs least, where a row without a column costs `unmatched`. Entries above `unmatched` (and
/// infinities) are never taken. Kuhn and Munkres' method, O(n^3).
std::vector<int> assign(const Eigen::MatrixXd& cost, double unmatched);

}  // namespace petal
