// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "unit_outcomes.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <utility>

#include "host_errors.hpp"
#include "json_tree.hpp"
#include "nearest.hpp"

namespace petal::compare {

using Json = nlohmann::ordered_json;

namespace {

bool is_pointer(const std::string& name) {
    return !name.empty() && name.front() == '/';
}

std::optional<double> number_in(const Json& json) {
    if (!json.is_number()) return std::nullopt;
    const double value = json.get<double>();
    return std::isfinite(value) ? std::optional(value) : std::nullopt;
}

std::optional<double> value_in(const Json& result, const std::string& name) {
    try {
        if (is_pointer(name)) return number_in(result.at(Json::json_pointer(name)));
        return number_in(result.at("metrics").at(name));
    } catch (const Json::exception&) {
        return std::nullopt;  // no such place
    }
}

/// What is in "metrics", by name.
std::map<std::string, double> all_values(const Json& result) {
    std::map<std::string, double> values;
    const auto metrics = result.find("metrics");
    if (metrics == result.end() || !metrics->is_object()) return values;
    for (const auto& [name, json] : metrics->items())
        if (const auto value = number_in(json)) values[name] = *value;
    return values;
}

Json parsed(const std::string& text) {
    Json result = Json::parse(text, nullptr, false);
    return result.is_object() ? result : Json::object();
}

std::string failure_of(const UnitRecord& record, FailsOn fails_on) {
    if (record.status != "done") return record.status;
    const bool by_verdict = (record.verdict == "not_usable" && fails_on != FailsOn::error) ||
                            (record.verdict == "weak" && fails_on == FailsOn::weak);
    return by_verdict ? record.verdict : "";
}

void add_values(const Comparison& comparison, const UnitRecord& record, UnitOutcome& outcome) {
    const Json result = parsed(record.result);
    if (comparison.metrics.empty()) outcome.values = all_values(result);
    for (const MetricSpec& metric : comparison.metrics)
        if (const auto value = value_in(result, metric.name)) outcome.values[metric.name] = *value;
}

/// All names that a metric could have had in these results.
std::vector<std::string> names_like(const std::string& wrong,
                                    const std::map<std::string, UnitRecord>& records) {
    std::set<std::string> names;
    for (const auto& [key, record] : records) {
        const Json result = parsed(record.result);
        if (!is_pointer(wrong)) {
            for (const auto& [name, value] : all_values(result)) names.insert(name);
            continue;
        }
        if (result.empty()) continue;
        const Json flat = result.flatten();
        for (const auto& [pointer, value] : flat.items())
            if (value.is_number()) names.insert(pointer);
    }
    return {names.begin(), names.end()};
}

}  // namespace

std::vector<UnitOutcome> make_outcomes(const Comparison& comparison, const Plan& plan,
                                       const std::map<std::string, UnitRecord>& records) {
    std::vector<UnitOutcome> outcomes;
    for (const Unit& unit : plan.units) {
        const auto found = records.find(unit.key);
        if (found == records.end()) continue;
        const UnitRecord& record = found->second;
        UnitOutcome outcome;
        outcome.variant = unit.variant;
        outcome.data = unit.data;
        outcome.seed = unit.seed;
        outcome.key = unit.key;
        outcome.verdict = record.verdict;
        outcome.failure = failure_of(record, comparison.fails_on);
        if (outcome.failure.empty()) {
            add_values(comparison, record, outcome);
        } else if (!record.reasons.empty()) {
            outcome.reason = record.reasons.front();
        }
        outcomes.push_back(std::move(outcome));
    }
    return outcomes;
}

bool check_metric_names(const Comparison& comparison, const Plan& plan,
                        const std::map<std::string, UnitRecord>& records, bool all_done) {
    const auto outcomes = make_outcomes(comparison, plan, records);
    std::set<std::size_t> data_seen;
    std::set<std::string> metrics_seen;
    for (const UnitOutcome& outcome : outcomes) {
        if (outcome.failure.empty()) data_seen.insert(outcome.data);
        for (const auto& [name, value] : outcome.values) metrics_seen.insert(name);
    }
    if (data_seen.empty() || (!all_done && data_seen.size() < comparison.data.size())) return false;
    for (const MetricSpec& metric : comparison.metrics) {
        if (metrics_seen.count(metric.name) > 0) continue;
        const auto names = names_like(metric.name, records);
        throw UsageError("no result has a number for the metric '" + printable(metric.name) + "'" +
                         expected_one_of(metric.name, names));
    }
    return true;
}

}  // namespace petal::compare
