// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <string>
#include <vector>

#include "figures.hpp"

namespace petal::compare {

/// HTML of one metric's plots: differences with their intervals, box plots of the values by
/// variant, and their distributions. `outcomes`: every unit once.
std::string metric_plots(const Comparison& comparison, const MetricFigures& figures,
                         const std::vector<UnitOutcome>& outcomes);

/// A curve for each metric over the values of a swept parameter.
std::string sweep_plots(const Comparison& comparison, const Figures& figures,
                        const std::string& param);

}  // namespace petal::compare
