// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "comparison.hpp"
#include "judge.hpp"

namespace petal::compare {

/// What one unit (variant x data x seed) came to, as the statistics see it.
struct UnitOutcome {
    std::size_t variant = 0;
    std::size_t data = 0;
    std::uint64_t seed = 0;
    std::string key;      ///< units of one key are one unit; empty: not known
    std::string failure;  ///< error, crash, not_usable, weak; empty: none
    std::string reason;   ///< of a failure
    std::string verdict;  ///< of the run; may be empty
    std::map<std::string, double>
        values;  ///< of the comparison's metrics, finite; without a failure
};

/// A variant's own figures of one metric, and how it stands to the reference.
struct VariantFigures {
    std::size_t units = 0;
    std::size_t failed = 0;   ///< units that failed, for whatever cause
    std::size_t missing = 0;  ///< did not fail, but the result lacks the metric: count as failed
    std::optional<Interval> median;  ///< of the values there are
    std::optional<Interval> mean;
    std::optional<MetricJudgement> judgement;  ///< none for the reference
};

struct MetricFigures {
    MetricSpec metric;
    std::vector<std::string> not_measured_on;  ///< data of which no unit has it: left out
    std::vector<VariantFigures> variants;
};

struct VariantFailures {
    std::size_t units = 0;
    std::map<std::string, std::size_t> by_cause;
    std::optional<FailureJudgement> judgement;  ///< none for the reference

    std::size_t count() const;
};

struct Figures {
    std::vector<MetricFigures> metrics;
    std::vector<VariantFailures> failures;  ///< by variant
    std::size_t tests = 0;  ///< p-values in Holm's family: those that could reach the level
};

/// All statistics of a comparison. `units` holds every unit once, in any order; the outcome does
/// not depend on it. Where the comparison names no metrics, all that any unit has are taken.
Figures make_figures(const Comparison& comparison, std::vector<UnitOutcome> units);

}  // namespace petal::compare
