// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include <map>
#include <tuple>

#include "number_text.hpp"
#include "report.hpp"

namespace petal::compare {

namespace {

/// RFC 4180: quotes where they are needed.
std::string cell(const std::string& text) {
    if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
    std::string quoted = "\"";
    for (const char c : text) quoted += c == '"' ? "\"\"" : std::string(1, c);
    return quoted + "\"";
}

using Place = std::tuple<std::size_t, std::uint64_t>;

}  // namespace

std::string csv_name(const MetricSpec& metric) {
    std::string name = metric.name;
    for (char& c : name) {
        const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') ||
                           (c >= '0' && c <= '9') || c == '.' || c == '-' || c == '_';
        if (!plain) c = '_';
    }
    if (name.front() == '.') name.front() = '_';
    return name + ".csv";
}

std::string metric_csv(const Comparison& comparison, const MetricSpec& metric,
                       const std::vector<UnitOutcome>& outcomes) {
    const auto value_of = [&](const UnitOutcome& outcome) {
        const auto found = outcome.values.find(metric.name);
        return found == outcome.values.end() ? nullptr : &found->second;
    };
    std::map<Place, const double*> reference;
    for (const UnitOutcome& outcome : outcomes)
        if (outcome.variant == comparison.reference)
            reference[{outcome.data, outcome.seed}] = value_of(outcome);
    std::string text = "data,seed,variant,failure,value,reference,difference\n";
    for (const UnitOutcome& outcome : outcomes) {
        const double* value = value_of(outcome);
        const auto other = reference.find({outcome.data, outcome.seed});
        const double* its = other == reference.end() ? nullptr : other->second;
        std::string failure = outcome.failure;
        if (failure.empty() && value == nullptr) failure = "missing";
        text += cell(comparison.data[outcome.data].name) + "," + std::to_string(outcome.seed) +
                "," + cell(comparison.variants[outcome.variant].name) + "," + failure + "," +
                (value ? number_text(*value) : "") + "," + (its ? number_text(*its) : "") + "," +
                (value && its ? number_text(*value - *its) : "") + "\n";
    }
    return text;
}

}  // namespace petal::compare
