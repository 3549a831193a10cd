// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "metrics/detail/error_figures.hpp"
#include "petal/calibration/metrics.hpp"

namespace petal {

/// The figures of `metric.normalised_reprojection` over some pairs, for one scene or (empty name)
/// in total. `expected` corners were to be found, at least as many as there are errors: those that
/// are not among `errors` count as farther off than any limit.
std::vector<Metric> table_two_figures(const std::vector<PairError>& errors, std::size_t expected,
                                      const std::string& scene);

}  // namespace petal
