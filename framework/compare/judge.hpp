// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <cstddef>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "bootstrap.hpp"
#include "comparison.hpp"

namespace petal::compare {

/// A variant and the reference on the same data with the same seed. Empty: that unit failed, or its
/// result lacks the metric.
struct Pair {
    std::size_t data = 0;
    std::optional<double> reference;
    std::optional<double> variant;
};

enum class Verdict { better, worse, differs, equivalent, undecided };
const char* to_string(Verdict verdict);

/// Fewer pairs decide nothing: five of five on one side have p = 0.0625.
constexpr std::size_t kFewestPairs = 6;

/// What the pairs say of one metric of one variant. Differences are variant - reference, in the
/// metric's unit.
struct MetricJudgement {
    std::size_t pairs = 0;  ///< that count: see independent_pairs()
    std::size_t neither_failed = 0;
    std::size_t only_variant_failed = 0;
    std::size_t only_reference_failed = 0;
    std::size_t both_failed = 0;
    Interval median;               ///< of the differences; a failure is worse than any value
    std::optional<Interval> mean;  ///< over the pairs in which neither failed
    double win_share = 0.0;        ///< pairs in which the variant is better; a tie counts half
    double margin = 0.0;           ///< in the metric's unit
    double p = 1.0;                ///< signed ranks, failures ranking highest
    double least_p = 1.0;          ///< that so many differences could have given
    int rank_direction = 0;        ///< sign of the differences by ranks
    double p_holm = 1.0;           ///< to be set against 1 - confidence
    Verdict verdict = Verdict::undecided;
    std::string reason;                     ///< why it is undecided
    std::optional<std::size_t> more_pairs;  ///< that would decide, with a chance of 80 %
};

/// The failures of a variant beside those of the reference, by the sign test.
struct FailureJudgement {
    std::size_t pairs = 0;
    std::size_t only_variant = 0;
    std::size_t only_reference = 0;
    double p = 1.0;
    double least_p = 1.0;
    double p_holm = 1.0;
    Verdict verdict = Verdict::undecided;
};

/// The pairs that tell something of their own: of a data item on which the seed changes nothing,
/// the first alone.
std::vector<Pair> independent_pairs(const std::vector<Pair>& pairs,
                                    const std::set<std::size_t>& seed_changes_nothing);

/// The figures that one metric's pairs give by themselves; `name` seeds the bootstrap. The verdict
/// waits for decide(). \pre pairs not empty.
MetricJudgement measure(const Comparison& comparison, const MetricSpec& metric,
                        const std::vector<Pair>& pairs, const std::string& name);
FailureJudgement measure_failures(const std::vector<Pair>& pairs);

/// Once p_holm is known, of a family of `tests` p-values.
void decide(MetricJudgement& judgement, const Comparison& comparison, Direction better,
            std::size_t tests);
void decide(FailureJudgement& judgement, const Comparison& comparison);

}  // namespace petal::compare
