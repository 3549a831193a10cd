// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "judge.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "petal/printed.hpp"
#include "rank_tests.hpp"

namespace petal::compare {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
/// More pairs than that nobody runs: told as not decidable.
constexpr double kMostPairs = 1e6;

/// The quantile of the normal distribution, by bisection of its tail: exact enough for counts.
double normal_quantile(double probability) {
    double low = -40.0;
    double high = 40.0;
    for (int i = 0; i < 200; ++i) {
        const double middle = 0.5 * (low + high);
        (0.5 * std::erfc(-middle / std::sqrt(2.0)) < probability ? low : high) = middle;
    }
    return 0.5 * (low + high);
}

/// variant - reference, where a failure is worse than every value, and two are equal.
double difference(const Pair& pair, Direction better) {
    const double worst = better == Direction::higher ? -kInfinity : kInfinity;
    if (pair.variant && pair.reference) return *pair.variant - *pair.reference;
    if (pair.variant) return -worst;
    return pair.reference ? worst : 0.0;
}

double margin_of(const MetricSpec& metric, const std::vector<Pair>& pairs) {
    if (!metric.margin_is_share) return metric.margin;
    std::vector<double> values;
    for (const Pair& pair : pairs)
        if (pair.reference) values.push_back(*pair.reference);
    return values.empty() ? 0.0 : metric.margin * std::abs(median_of(std::move(values)));
}

/// Share of pairs by which the variant fails more often.
double excess_failures(const MetricJudgement& judgement) {
    return (static_cast<double>(judgement.only_variant_failed) -
            static_cast<double>(judgement.only_reference_failed)) /
           static_cast<double>(judgement.pairs);
}

/// How many more pairs would show the difference, or that it stays inside the margin: the distance
/// from the median to the interval's end on that side shrinks as 1/sqrt(n). Holm's first, strictest
/// level is taken.
std::optional<std::size_t> more_pairs(const MetricJudgement& judgement, double confidence,
                                      std::size_t tests, bool difference_may_count,
                                      bool equivalence_may_count) {
    const Interval& median = judgement.median;
    const bool positive = median.value > 0.0;
    const double inward = positive ? median.value - median.low : median.high - median.value;
    const double outward = positive ? median.high - median.value : median.value - median.low;
    const double distance = std::abs(median.value);
    const double alpha = 1.0 - confidence;
    const auto family = static_cast<double>(tests);
    const double power = normal_quantile(0.8);
    const double now = normal_quantile(1.0 - 0.5 * alpha);
    const double strictest = normal_quantile(1.0 - 0.5 * alpha / family);
    const auto n = static_cast<double>(judgement.pairs);
    double needed = kInfinity;
    const auto consider = [&](double width, double level, double room, double fewest) {
        if (!std::isfinite(width) || !std::isfinite(distance) || room <= 0.0) return;
        const double ratio = (level + power) / now * width / room;
        needed = std::min(needed, std::max(fewest, n * ratio * ratio));
    };
    const auto fewest = static_cast<double>(kFewestPairs);
    // With fewer, no p-value of signs is small enough.
    const double signs = std::ceil(1.0 + std::log2(family / alpha));
    if (difference_may_count) consider(inward, strictest, distance, std::max(fewest, signs));
    if (equivalence_may_count) consider(outward, now, judgement.margin - distance, fewest);
    if (needed > kMostPairs) return std::nullopt;
    return static_cast<std::size_t>(std::max(1.0, std::ceil(needed - n)));
}

/// All differences on one side: 2 of 2^count patterns of signs.
double least_p_of(std::size_t count) {
    return std::min(1.0, std::exp2(1.0 - static_cast<double>(count)));
}

}  // namespace

const char* to_string(Verdict verdict) {
    switch (verdict) {
        case Verdict::better:
            return "better";
        case Verdict::worse:
            return "worse";
        case Verdict::differs:
            return "differs";
        case Verdict::equivalent:
            return "equivalent";
        case Verdict::undecided:
            return "undecided";
    }
    return "undecided";
}

std::vector<Pair> independent_pairs(const std::vector<Pair>& pairs,
                                    const std::set<std::size_t>& seed_changes_nothing) {
    std::set<std::size_t> taken;
    std::vector<Pair> independent;
    for (const Pair& pair : pairs)
        if (seed_changes_nothing.count(pair.data) == 0 || taken.insert(pair.data).second)
            independent.push_back(pair);
    return independent;
}

MetricJudgement measure(const Comparison& comparison, const MetricSpec& metric,
                        const std::vector<Pair>& pairs, const std::string& name) {
    MetricJudgement judgement;
    judgement.pairs = pairs.size();
    judgement.margin = margin_of(metric, pairs);
    const double sign = metric.better == Direction::higher ? -1.0 : 1.0;
    std::vector<double> differences;
    std::vector<double> of_values;
    for (const Pair& pair : pairs) {
        const double one = difference(pair, metric.better);
        differences.push_back(one);
        judgement.win_share += one * sign < 0.0 ? 1.0 : (one == 0.0 ? 0.5 : 0.0);
        if (pair.variant && pair.reference) {
            of_values.push_back(one);
        } else if (pair.reference) {
            ++judgement.only_variant_failed;
        } else if (pair.variant) {
            ++judgement.only_reference_failed;
        } else {
            ++judgement.both_failed;
        }
    }
    judgement.neither_failed = of_values.size();
    judgement.win_share /= static_cast<double>(pairs.size());
    Bootstrap bootstrap(comparison.seed, name, comparison.confidence);
    judgement.median = bootstrap.median(differences);
    if (!of_values.empty()) judgement.mean = bootstrap.mean(of_values);
    const SignedRank ranked = signed_rank(differences);
    judgement.p = ranked.p;
    judgement.rank_direction = ranked.direction;
    judgement.least_p =
        least_p_of(differences.size() - static_cast<std::size_t>(std::count(
                                            differences.begin(), differences.end(), 0.0)));
    judgement.p_holm = judgement.p;
    return judgement;
}

FailureJudgement measure_failures(const std::vector<Pair>& pairs) {
    FailureJudgement judgement;
    judgement.pairs = pairs.size();
    for (const Pair& pair : pairs) {
        if (!pair.variant && pair.reference) ++judgement.only_variant;
        if (pair.variant && !pair.reference) ++judgement.only_reference;
    }
    judgement.p = sign_p(judgement.only_variant, judgement.only_reference);
    judgement.least_p = least_p_of(judgement.only_variant + judgement.only_reference);
    judgement.p_holm = judgement.p;
    return judgement;
}

void decide(MetricJudgement& judgement, const Comparison& comparison, Direction better,
            std::size_t tests) {
    const double excess = excess_failures(judgement);
    const bool as_many_failures = std::abs(excess) <= comparison.failure_margin;
    const double sign = better == Direction::higher ? -1.0 : 1.0;
    const bool looks_better = sign * judgement.median.value < 0.0;
    // Whoever fails more often gets no advantage from being better on the rest.
    const bool failures_allow = (looks_better ? excess : -excess) <= comparison.failure_margin;
    const auto undecided = [&](const std::string& why) {
        judgement.verdict = Verdict::undecided;
        judgement.reason = why;
        judgement.more_pairs =
            more_pairs(judgement, comparison.confidence, tests, failures_allow, as_many_failures);
    };
    if (judgement.pairs < kFewestPairs)
        return undecided(printed("only %zu pairs tell something; %zu are needed at least",
                                 judgement.pairs, kFewestPairs));
    const Interval& median = judgement.median;
    const bool accuracy_seen = judgement.neither_failed >= kFewestPairs;
    if (as_many_failures && accuracy_seen && median.low >= -judgement.margin &&
        median.high <= judgement.margin) {
        judgement.verdict = Verdict::equivalent;
        return;
    }
    if (judgement.p_holm > 1.0 - comparison.confidence)
        return undecided(printed("p %.3g after Holm", judgement.p_holm));
    if (median.low <= 0.0 && median.high >= 0.0) return undecided("the median's interval holds 0");
    if (judgement.rank_direction * median.value < 0.0)
        return undecided("the median and the ranks point in opposite directions");
    if (!failures_allow)
        return undecided(looks_better ? "more accurate, but it fails more often"
                                      : "less accurate, but the reference fails more often");
    judgement.verdict = better == Direction::none ? Verdict::differs
                        : looks_better            ? Verdict::better
                                                  : Verdict::worse;
}

void decide(FailureJudgement& judgement, const Comparison& comparison) {
    if (judgement.p_holm > 1.0 - comparison.confidence) return;
    judgement.verdict =
        judgement.only_variant > judgement.only_reference ? Verdict::worse : Verdict::better;
}

}  // namespace petal::compare
