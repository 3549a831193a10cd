// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <map>
#include <string>
#include <vector>

#include "figures.hpp"
#include "plan.hpp"
#include "unit_store.hpp"

namespace petal::compare {

/// The outcome of every unit of the plan that has a record: failures by the comparison's rule, and
/// the values of its metrics.
std::vector<UnitOutcome> make_outcomes(const Comparison& comparison, const Plan& plan,
                                       const std::map<std::string, UnitRecord>& records);

/// Looks for metrics that no result has. Before the last unit (`all_done` false) it tells them only
/// once every data item has a unit that did not fail. \throws UsageError naming the metric and the
/// nearest one that results have. Tells whether all were found.
bool check_metric_names(const Comparison& comparison, const Plan& plan,
                        const std::map<std::string, UnitRecord>& records, bool all_done);

}  // namespace petal::compare
