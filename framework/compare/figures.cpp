// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "figures.hpp"

#include <algorithm>
#include <set>
#include <tuple>
#include <utility>

#include "rank_tests.hpp"

namespace petal::compare {

namespace {

/// The units of a comparison by place.
class UnitTable {
   public:
    explicit UnitTable(std::vector<UnitOutcome> units) : units_(std::move(units)) {
        std::sort(units_.begin(), units_.end(), [](const UnitOutcome& a, const UnitOutcome& b) {
            return std::tie(a.variant, a.data, a.seed) < std::tie(b.variant, b.data, b.seed);
        });
        for (const UnitOutcome& unit : units_)
            by_place_[{unit.variant, unit.data, unit.seed}] = &unit;
    }

    const std::vector<UnitOutcome>& all() const { return units_; }

    /// Data of which no variant's outcome differs between two seeds.
    std::set<std::size_t> data_without_chance() const {
        std::set<std::size_t> fixed;
        std::set<std::size_t> varied;
        std::map<std::pair<std::size_t, std::size_t>, const UnitOutcome*> first;
        for (const UnitOutcome& unit : units_) {
            fixed.insert(unit.data);
            const auto [at, is_new] = first.insert({{unit.variant, unit.data}, &unit});
            const UnitOutcome& other = *at->second;
            if (unit.failure != other.failure || unit.values != other.values)
                varied.insert(unit.data);
        }
        for (const std::size_t data : varied) fixed.erase(data);
        return fixed;
    }

    /// The pairs of a variant with the reference, where both are there.
    template <class Value>
    std::vector<Pair> pairs(std::size_t variant, std::size_t reference, Value value) const {
        std::vector<Pair> pairs;
        std::set<std::pair<std::string, std::string>> seen;  // alike data are no further evidence
        for (const UnitOutcome& unit : units_) {
            if (unit.variant != variant) continue;
            const auto other = by_place_.find({reference, unit.data, unit.seed});
            if (other == by_place_.end()) continue;
            if (!unit.key.empty() && !seen.insert({other->second->key, unit.key}).second) continue;
            pairs.push_back({unit.data, value(*other->second), value(unit)});
        }
        return pairs;
    }

   private:
    std::vector<UnitOutcome> units_;
    std::map<std::tuple<std::size_t, std::size_t, std::uint64_t>, const UnitOutcome*> by_place_;
};

std::optional<double> value_of(const UnitOutcome& unit, const std::string& metric) {
    const auto found = unit.values.find(metric);
    if (!unit.failure.empty() || found == unit.values.end()) return std::nullopt;
    return found->second;
}

/// Data on which units did not fail, yet none has the metric: it is not measured there.
std::set<std::size_t> data_without(const UnitTable& table, const std::string& metric) {
    std::set<std::size_t> with;
    std::set<std::size_t> usable;
    for (const UnitOutcome& unit : table.all()) {
        if (unit.failure.empty()) usable.insert(unit.data);
        if (value_of(unit, metric)) with.insert(unit.data);
    }
    std::set<std::size_t> without;
    for (const std::size_t data : usable)
        if (with.count(data) == 0) without.insert(data);
    return without;
}

std::vector<MetricSpec> metrics_of(const Comparison& comparison, const UnitTable& table) {
    if (!comparison.metrics.empty()) return comparison.metrics;
    std::set<std::string> names;
    for (const UnitOutcome& unit : table.all())
        for (const auto& [name, value] : unit.values) names.insert(name);
    std::vector<MetricSpec> metrics;
    for (const std::string& name : names) {
        MetricSpec metric;
        metric.name = name;
        metrics.push_back(std::move(metric));
    }
    return metrics;
}

VariantFigures figures_of(const Comparison& comparison, const MetricSpec& metric,
                          const UnitTable& table, std::size_t variant,
                          const std::set<std::size_t>& not_measured) {
    VariantFigures figures;
    std::vector<double> values;
    for (const UnitOutcome& unit : table.all()) {
        if (unit.variant != variant || not_measured.count(unit.data) > 0) continue;
        ++figures.units;
        const auto value = value_of(unit, metric.name);
        if (value) values.push_back(*value);
        if (!unit.failure.empty()) {
            ++figures.failed;
        } else if (!value) {
            ++figures.missing;
        }
    }
    const std::string name = metric.name + "\n" + comparison.variants[variant].name;
    Bootstrap bootstrap(comparison.seed, name + "\nvalues", comparison.confidence);
    if (!values.empty()) {
        figures.median = bootstrap.median(values);
        figures.mean = bootstrap.mean(values);
    }
    if (variant == comparison.reference) return figures;
    auto pairs = table.pairs(variant, comparison.reference,
                             [&](const UnitOutcome& unit) { return value_of(unit, metric.name); });
    pairs.erase(std::remove_if(pairs.begin(), pairs.end(),
                               [&](const Pair& pair) { return not_measured.count(pair.data) > 0; }),
                pairs.end());
    pairs = independent_pairs(pairs, table.data_without_chance());
    if (!pairs.empty()) figures.judgement = measure(comparison, metric, pairs, name);
    return figures;
}

VariantFailures failures_of(const Comparison& comparison, const UnitTable& table,
                            std::size_t variant) {
    VariantFailures failures;
    for (const UnitOutcome& unit : table.all()) {
        if (unit.variant != variant) continue;
        ++failures.units;
        if (!unit.failure.empty()) ++failures.by_cause[unit.failure];
    }
    if (variant == comparison.reference) return failures;
    const auto pairs = independent_pairs(
        table.pairs(variant, comparison.reference,
                    [](const UnitOutcome& unit) {
                        return unit.failure.empty() ? std::optional<double>(0.0) : std::nullopt;
                    }),
        table.data_without_chance());
    if (!pairs.empty()) failures.judgement = measure_failures(pairs);
    return failures;
}

/// Holm over all variants and metrics, failures among them; then the verdicts. A test that could
/// not have reached the level whatever its pairs said (Tarone) takes nothing from the others.
void decide_all(const Comparison& comparison, Figures& figures) {
    std::vector<double> p_values;
    const auto each = [&](auto metric_judgement, auto failure_judgement) {
        for (MetricFigures& metric : figures.metrics)
            for (VariantFigures& variant : metric.variants)
                if (variant.judgement) metric_judgement(*variant.judgement, metric.metric);
        for (VariantFailures& variant : figures.failures)
            if (variant.judgement) failure_judgement(*variant.judgement);
    };
    const auto counts = [&](const auto& judgement) {
        return judgement.least_p <= 1.0 - comparison.confidence;
    };
    const auto collect = [&](const auto& judgement) {
        if (counts(judgement)) p_values.push_back(judgement.p);
    };
    each([&](MetricJudgement& judgement, const MetricSpec&) { collect(judgement); }, collect);
    const std::vector<double> adjusted = holm(p_values);
    figures.tests = adjusted.size();
    auto next = adjusted.begin();
    each(
        [&](MetricJudgement& judgement, const MetricSpec& metric) {
            if (counts(judgement)) judgement.p_holm = *next++;
            decide(judgement, comparison, metric.better, std::max<std::size_t>(1, adjusted.size()));
        },
        [&](FailureJudgement& judgement) {
            if (counts(judgement)) judgement.p_holm = *next++;
            decide(judgement, comparison);
        });
}

}  // namespace

std::size_t VariantFailures::count() const {
    std::size_t sum = 0;
    for (const auto& [cause, count] : by_cause) sum += count;
    return sum;
}

Figures make_figures(const Comparison& comparison, std::vector<UnitOutcome> units) {
    const UnitTable table(std::move(units));
    Figures figures;
    for (MetricSpec& metric : metrics_of(comparison, table)) {
        MetricFigures of_metric;
        const auto not_measured = data_without(table, metric.name);
        for (const std::size_t data : not_measured)
            of_metric.not_measured_on.push_back(comparison.data[data].name);
        for (std::size_t v = 0; v < comparison.variants.size(); ++v)
            of_metric.variants.push_back(figures_of(comparison, metric, table, v, not_measured));
        of_metric.metric = std::move(metric);
        figures.metrics.push_back(std::move(of_metric));
    }
    for (std::size_t v = 0; v < comparison.variants.size(); ++v)
        figures.failures.push_back(failures_of(comparison, table, v));
    decide_all(comparison, figures);
    return figures;
}

}  // namespace petal::compare
