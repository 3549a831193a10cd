// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "report_plots.hpp"

#include <algorithm>

#include "petal/html/plots.hpp"

namespace petal::compare {

namespace {

constexpr std::size_t kMostCurves = 6;  // tones there are; more curves could not be told apart

std::string axis_name(const MetricSpec& metric) {
    return metric.name + (metric.unit.empty() ? "" : ", " + metric.unit);
}

int tone_of(std::size_t variant) {
    return static_cast<int>(variant % kMostCurves);
}

/// The metric's values by variant, of units that did not fail.
std::vector<std::vector<double>> values_by_variant(const Comparison& comparison,
                                                   const MetricSpec& metric,
                                                   const std::vector<UnitOutcome>& outcomes) {
    std::vector<std::vector<double>> values(comparison.variants.size());
    for (const UnitOutcome& outcome : outcomes) {
        const auto found = outcome.values.find(metric.name);
        if (outcome.failure.empty() && found != outcome.values.end())
            values[outcome.variant].push_back(found->second);
    }
    return values;
}

}  // namespace

std::string metric_plots(const Comparison& comparison, const MetricFigures& figures,
                         const std::vector<UnitOutcome>& outcomes) {
    const std::string axis = axis_name(figures.metric);
    std::vector<html::IntervalRow> differences;
    for (std::size_t v = 0; v < figures.variants.size(); ++v)
        if (const auto& judgement = figures.variants[v].judgement)
            differences.push_back({comparison.variants[v].name, judgement->median.value,
                                   judgement->median.low, judgement->median.high, judgement->margin,
                                   tone_of(v)});
    std::string text;
    if (!differences.empty())
        text +=
            "<h3>Median differences from the reference</h3>\n<p class=\"soft\">The band is what "
            "does not matter; an arrow is an end among units that failed.</p>\n" +
            html::interval_plot({"Differences of " + figures.metric.name, axis}, differences);
    const auto values = values_by_variant(comparison, figures.metric, outcomes);
    std::vector<html::Box> boxes;
    std::vector<html::Sample> samples;
    for (std::size_t v = 0; v < values.size(); ++v) {
        if (values[v].empty()) continue;
        const std::string& name = comparison.variants[v].name;
        boxes.push_back({name, "", html::five_numbers(values[v]), tone_of(v), ""});
        if (samples.size() < kMostCurves) samples.push_back({name, values[v], tone_of(v)});
    }
    if (boxes.empty()) return text + "<p>No unit has a value.</p>\n";
    text +=
        "<h3>Values of the units that did not fail</h3>\n<p class=\"soft\">A box holds the middle "
        "half, its line is the median, the ends are the smallest and the largest.</p>\n" +
        html::box_plot({"Values of " + figures.metric.name, axis}, boxes, false) +
        "<h3>Distribution</h3>\n<p class=\"soft\">The share of units below each value, and below "
        "it every value of its own.</p>\n" +
        html::distribution_plot({"Distribution of " + figures.metric.name, axis}, samples);
    if (samples.size() < boxes.size())
        text += "<p class=\"soft\">The first " + std::to_string(samples.size()) + " of " +
                std::to_string(boxes.size()) + " variants.</p>\n";
    return text;
}

std::string sweep_plots(const Comparison& comparison, const Figures& figures,
                        const std::string& param) {
    std::string text;
    for (const MetricFigures& metric : figures.metrics) {
        std::vector<html::CurvePoint> points;
        for (std::size_t v = 0; v < comparison.variants.size(); ++v) {
            const auto& swept = comparison.variants[v].swept;
            if (!swept || swept->param != param) continue;
            html::CurvePoint point;
            point.x = swept->value;
            if (const auto& median = metric.variants[v].median) {
                point.y = median->value;
                point.low = median->low;
                point.high = median->high;
            }
            points.push_back(std::move(point));
        }
        text += html::curve_plot(
            {"Median of " + metric.metric.name + " over " + param, axis_name(metric.metric)}, param,
            points);
    }
    return text;
}

}  // namespace petal::compare
