// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

#include "report.hpp"
#include "run_report.hpp"

namespace petal::compare {

using Json = nlohmann::ordered_json;

namespace {

Json number_json(double value) {
    if (std::isinf(value)) return value > 0.0 ? "inf" : "-inf";
    return value;
}

Json interval_json(const std::optional<Interval>& interval) {
    if (!interval) return nullptr;
    return {{"value", number_json(interval->value)},
            {"low", number_json(interval->low)},
            {"high", number_json(interval->high)}};
}

Json judgement_json(const Comparison& comparison, const MetricJudgement& judgement) {
    Json json{{"verdict", to_string(judgement.verdict)}};
    if (!judgement.reason.empty()) json["reason"] = judgement.reason;
    if (judgement.verdict == Verdict::undecided) {
        json["more_pairs"] = judgement.more_pairs ? Json(*judgement.more_pairs) : Json();
        json["more_seeds"] =
            judgement.more_pairs ? Json(more_seeds(comparison, judgement)) : Json();
    }
    json["pairs"] = judgement.pairs;
    json["neither_failed"] = judgement.neither_failed;
    json["only_variant_failed"] = judgement.only_variant_failed;
    json["only_reference_failed"] = judgement.only_reference_failed;
    json["both_failed"] = judgement.both_failed;
    json["median_difference"] = interval_json(judgement.median);
    json["mean_difference"] = interval_json(judgement.mean);
    json["win_share"] = judgement.win_share;
    json["margin"] = judgement.margin;
    json["p"] = judgement.p;
    json["p_holm"] = judgement.p_holm;
    return json;
}

Json metric_json(const Comparison& comparison, const MetricFigures& figures) {
    Json variants = Json::object();
    for (std::size_t v = 0; v < figures.variants.size(); ++v) {
        const VariantFigures& its = figures.variants[v];
        Json one{{"units", its.units},
                 {"failed", its.failed},
                 {"missing", its.missing},
                 {"median", interval_json(its.median)},
                 {"mean", interval_json(its.mean)}};
        if (its.judgement) one["to_reference"] = judgement_json(comparison, *its.judgement);
        variants[comparison.variants[v].name] = std::move(one);
    }
    const MetricSpec& metric = figures.metric;
    return {{"name", metric.name},
            {"unit", metric.unit},
            {"better", to_string(metric.better)},
            {metric.margin_is_share ? "margin_share" : "margin", metric.margin},
            {"not_measured_on", figures.not_measured_on},
            {"variants", std::move(variants)}};
}

Json failures_json(const VariantFailures& failures) {
    Json json{
        {"units", failures.units}, {"failed", failures.count()}, {"by_cause", failures.by_cause}};
    if (const auto& judgement = failures.judgement)
        json["to_reference"] = {{"verdict", to_string(judgement->verdict)},
                                {"pairs", judgement->pairs},
                                {"only_variant_failed", judgement->only_variant},
                                {"only_reference_failed", judgement->only_reference},
                                {"p", judgement->p},
                                {"p_holm", judgement->p_holm}};
    return json;
}

Json sweeps_json(const Comparison& comparison, const Figures& figures) {
    Json sweeps = Json::object();
    for (std::size_t v = 0; v < comparison.variants.size(); ++v) {
        const auto& point = comparison.variants[v].swept;
        if (!point) continue;
        Json row{{"value", Json::parse(point->value, nullptr, false)},
                 {"variant", comparison.variants[v].name},
                 {"failed", figures.failures[v].count()}};
        for (const MetricFigures& metric : figures.metrics)
            row["median"][metric.metric.name] = interval_json(metric.variants[v].median);
        sweeps[point->param].push_back(std::move(row));
    }
    return sweeps;
}

Json versions_json(const Plan& plan) {
    std::map<std::string, std::string> plugins;
    for (const auto& by_data : plan.pipelines)
        for (const PlannedPipeline& pipeline : by_data)
            plugins.insert(pipeline.versions.begin(), pipeline.versions.end());
    return {{"petal", version()}, {"plugins", plugins}};
}

Json data_json(const Comparison& comparison) {
    Json data = Json::array();
    for (const DataItem& item : comparison.data)
        data.push_back({{"name", item.name}, {"seeds", comparison.seeds_of(item)}});
    return data;
}

std::string dumped(const Json& json) {
    return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace

std::string compare_json(const Comparison& comparison, const Plan& plan, const Figures& figures,
                         const std::vector<UnitOutcome>& outcomes) {
    Json names = Json::array();
    for (const Variant& variant : comparison.variants) names.push_back(variant.name);
    Json failures = Json::object();
    for (std::size_t v = 0; v < comparison.variants.size(); ++v)
        failures[comparison.variants[v].name] = failures_json(figures.failures[v]);
    Json metrics = Json::array();
    for (const MetricFigures& metric : figures.metrics)
        metrics.push_back(metric_json(comparison, metric));
    Json failed = Json::array();
    for (const UnitOutcome& outcome : outcomes)
        if (!outcome.failure.empty())
            failed.push_back({{"variant", comparison.variants[outcome.variant].name},
                              {"data", comparison.data[outcome.data].name},
                              {"seed", outcome.seed},
                              {"cause", outcome.failure},
                              {"reason", outcome.reason}});
    Json root{{"petal_compare", 1},
              {"name", comparison.name},
              {"about", comparison.about},
              {"reference", comparison.variants[comparison.reference].name},
              {"variants", std::move(names)},
              {"data", data_json(comparison)},
              {"confidence", comparison.confidence},
              {"seed", comparison.seed},
              {"resamples", Bootstrap::kResamples},
              {"tests", figures.tests},
              {"failure", to_string(comparison.fails_on)},
              {"failure_margin", comparison.failure_margin},
              {"versions", versions_json(plan)},
              {"failures", std::move(failures)},
              {"metrics", std::move(metrics)},
              {"sweeps", sweeps_json(comparison, figures)},
              {"failed_units", std::move(failed)}};
    return dumped(root);
}

std::string run_json(const Comparison& comparison, const Plan& plan, const UnitRuns& runs,
                     const std::string& status, double wall_s) {
    std::map<std::string, std::pair<std::size_t, std::size_t>> stages;  // executed, shared
    std::size_t executed = 0;
    std::size_t shared = 0;
    std::size_t failed = 0;
    double unit_wall_s = 0.0;
    for (const auto& [key, record] : runs.records) {
        for (const std::string& id : record.executed) ++stages[id].first;
        for (const std::string& id : record.shared) ++stages[id].second;
        executed += record.executed.size();
        shared += record.shared.size();
        if (record.status != "done") ++failed;
        unit_wall_s += record.wall_s;
    }
    Json by_stage = Json::object();
    for (const auto& [id, counts] : stages)
        by_stage[id] = {{"executed", counts.first}, {"shared", counts.second}};
    return dumped({{"petal_compare", 1},
                   {"name", comparison.name},
                   {"status", status},
                   {"versions", versions_json(plan)},
                   {"units",
                    {{"planned", plan.units.size()},
                     {"different", runs.records.size()},
                     {"run_now", runs.records.size() - runs.reused},
                     {"found_finished", runs.reused},
                     {"failed", failed},
                     {"wall_s", unit_wall_s}}},
                   {"stages",
                    {{"executed", executed},
                     {"shared", shared},
                     {"without_sharing", executed + shared},
                     {"by_id", std::move(by_stage)}}},
                   {"wall_s", wall_s}});
}

std::size_t more_seeds(const Comparison& comparison, const MetricJudgement& judgement) {
    const std::size_t data = std::max<std::size_t>(1, comparison.data.size());
    return (judgement.more_pairs.value_or(0) + data - 1) / data;
}

}  // namespace petal::compare
