// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include <algorithm>
#include <cmath>

#include "petal/printed.hpp"
#include "report.hpp"

namespace petal::compare {

namespace {

/// Rows of cells, the first one left-aligned, the others right.
class Table {
   public:
    void row(std::vector<std::string> cells) { rows_.push_back(std::move(cells)); }

    std::string text() const {
        std::vector<std::size_t> widths;
        for (const auto& cells : rows_)
            for (std::size_t i = 0; i < cells.size(); ++i) {
                if (i == widths.size()) widths.push_back(0);
                widths[i] = std::max(widths[i], cells[i].size());
            }
        std::string text;
        for (const auto& cells : rows_) {
            std::string line;
            for (std::size_t i = 0; i < cells.size(); ++i) {
                const std::string space(widths[i] - cells[i].size(), ' ');
                const bool left = i == 0 || i + 1 == cells.size();
                line += "  " + (left ? cells[i] + space : space + cells[i]);
            }
            line.erase(line.find_last_not_of(' ') + 1);
            text += line + "\n";
        }
        return text;
    }

   private:
    std::vector<std::vector<std::string>> rows_;
};

std::string figure(double value, bool with_sign = false) {
    if (std::isinf(value)) return value > 0.0 ? "+fails" : "-fails";
    return printed(with_sign ? "%+.3g" : "%.4g", value);
}

std::string interval_text(const std::optional<Interval>& interval, bool with_sign = false) {
    if (!interval) return "-";
    return figure(interval->value, with_sign) + " [" + figure(interval->low, with_sign) + ", " +
           figure(interval->high, with_sign) + "]";
}

std::string verdict_text(const Comparison& comparison, const MetricJudgement& judgement) {
    std::string text = to_string(judgement.verdict);
    if (judgement.verdict != Verdict::undecided) return text;
    text += ": " + judgement.reason;
    if (judgement.more_pairs)
        text += printed("; about %zu more seeds would decide", more_seeds(comparison, judgement));
    return text;
}

std::string heading(const MetricFigures& figures) {
    const MetricSpec& metric = figures.metric;
    std::string text = metric.name;
    if (!metric.unit.empty()) text += " (" + metric.unit + ")";
    if (metric.better != Direction::none)
        text += std::string(", ") + to_string(metric.better) + " is better";
    if (metric.margin > 0.0)
        text += metric.margin_is_share
                    ? printed(", equivalent within %g %% of the reference", 100.0 * metric.margin)
                    : printed(", equivalent within %g", metric.margin);
    for (std::size_t i = 0; i < figures.not_measured_on.size(); ++i)
        text += (i == 0 ? "; not measured on " : ", ") + figures.not_measured_on[i];
    return text + "\n";
}

std::string metric_table(const Comparison& comparison, const MetricFigures& figures) {
    const std::string confidence = printed("%g %%", 100.0 * comparison.confidence);
    Table table;
    table.row({"variant", "units", "failed", "median [" + confidence + "]",
               "median difference [" + confidence + "]", "mean difference", "wins", "p",
               "verdict"});
    for (std::size_t v = 0; v < figures.variants.size(); ++v) {
        const VariantFigures& its = figures.variants[v];
        std::vector<std::string> cells{comparison.variants[v].name, std::to_string(its.units),
                                       std::to_string(its.failed + its.missing),
                                       interval_text(its.median)};
        if (const auto& judgement = its.judgement) {
            cells.push_back(interval_text(judgement->median, true));
            cells.push_back(judgement->mean ? figure(judgement->mean->value, true) : "-");
            cells.push_back(printed("%.0f %%", 100.0 * judgement->win_share));
            cells.push_back(printed("%.2g", judgement->p_holm));
            cells.push_back(verdict_text(comparison, *judgement));
        } else if (v == comparison.reference) {
            cells.insert(cells.end(), {"", "", "", "", "(reference)"});
        }
        table.row(std::move(cells));
    }
    return heading(figures) + table.text();
}

std::string failure_table(const Comparison& comparison, const Figures& figures) {
    Table table;
    table.row({"variant", "units", "failed", "it alone", "reference alone", "p", "verdict"});
    for (std::size_t v = 0; v < figures.failures.size(); ++v) {
        const VariantFailures& its = figures.failures[v];
        std::string causes;
        for (const auto& [cause, count] : its.by_cause)
            causes += (causes.empty() ? " (" : ", ") + std::to_string(count) + " " + cause;
        std::vector<std::string> cells{
            comparison.variants[v].name, std::to_string(its.units),
            std::to_string(its.count()) + (causes.empty() ? "" : causes + ")")};
        if (const auto& judgement = its.judgement) {
            const bool decided = judgement->verdict != Verdict::undecided;
            const bool none = judgement->only_variant + judgement->only_reference == 0;
            cells.insert(
                cells.end(),
                {std::to_string(judgement->only_variant), std::to_string(judgement->only_reference),
                 printed("%.2g", judgement->p_holm),
                 none && !decided ? "no difference seen" : to_string(judgement->verdict)});
        } else if (v == comparison.reference) {
            cells.insert(cells.end(), {"", "", "", "(reference)"});
        }
        table.row(std::move(cells));
    }
    return "failures\n" + table.text();
}

std::string sweep_table(const Comparison& comparison, const Figures& figures,
                        const std::string& param) {
    Table table;
    std::vector<std::string> head{"value", "failed"};
    for (const MetricFigures& metric : figures.metrics) head.push_back(metric.metric.name);
    head.emplace_back("");
    table.row(std::move(head));
    for (std::size_t v = 0; v < comparison.variants.size(); ++v) {
        const auto& point = comparison.variants[v].swept;
        if (!point || point->param != param) continue;
        std::vector<std::string> cells{point->value, std::to_string(figures.failures[v].count())};
        for (const MetricFigures& metric : figures.metrics)
            cells.push_back(interval_text(metric.variants[v].median));
        cells.emplace_back("");
        table.row(std::move(cells));
    }
    return "sensitivity to " + param + " (medians)\n" + table.text();
}

}  // namespace

std::string table_text(const Comparison& comparison, const Figures& figures) {
    std::string text;
    for (const MetricFigures& metric : figures.metrics)
        text += metric_table(comparison, metric) + "\n";
    text += failure_table(comparison, figures);
    std::vector<std::string> params;
    for (const Variant& variant : comparison.variants) {
        if (!variant.swept || std::count(params.begin(), params.end(), variant.swept->param) > 0)
            continue;
        params.push_back(variant.swept->param);
        text += "\n" + sweep_table(comparison, figures, params.back());
    }
    return text;
}

}  // namespace petal::compare
