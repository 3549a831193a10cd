// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "selection.hpp"

#include <algorithm>
#include <charconv>
#include <set>
#include <utility>

#include "host_errors.hpp"
#include "nearest.hpp"
#include "seed_range.hpp"

namespace petal::compare {

namespace {

template <class Named>
bool has(const std::vector<Named>& all, const std::string& name) {
    return std::any_of(all.begin(), all.end(), [&](const Named& one) { return one.name == name; });
}

void apply_only(const std::vector<std::string>& only, Comparison& comparison) {
    bool some_variant = false;
    bool some_data = false;
    for (const std::string& name : only) {
        const bool variant = has(comparison.variants, name);
        const bool data = has(comparison.data, name);
        some_variant = some_variant || variant;
        some_data = some_data || data;
        if (variant || data) continue;
        std::vector<std::string> names;
        for (const Variant& one : comparison.variants) names.push_back(one.name);
        for (const DataItem& one : comparison.data) names.push_back(one.name);
        throw UsageError("--only " + printable(name) + ": no such variant or data" +
                         expected_one_of(name, names));
    }
    const auto left_out = [&](const auto& one) {
        return std::count(only.begin(), only.end(), one.name) == 0;
    };
    if (some_variant) {
        const std::string reference = comparison.variants[comparison.reference].name;
        auto& all = comparison.variants;
        all.erase(std::remove_if(
                      all.begin(), all.end(),
                      [&](const Variant& one) { return one.name != reference && left_out(one); }),
                  all.end());
        const auto at = std::find_if(all.begin(), all.end(),
                                     [&](const Variant& one) { return one.name == reference; });
        comparison.reference = static_cast<std::size_t>(at - all.begin());
    }
    if (some_data)
        comparison.data.erase(
            std::remove_if(comparison.data.begin(), comparison.data.end(), left_out),
            comparison.data.end());
}

void apply_folders(const std::vector<std::string>& folders, Comparison& comparison) {
    if (folders.empty()) return;
    comparison.data.clear();
    for (const std::string& folder : folders) {
        DataItem item;
        const std::filesystem::path path = std::filesystem::path(folder).lexically_normal();
        item.name =
            path.has_filename() ? path.filename().string() : path.parent_path().filename().string();
        if (item.name.empty() || item.name == "." || has(comparison.data, item.name))
            item.name = folder;
        if (has(comparison.data, item.name))
            throw UsageError("--data " + folder + " is given twice; give each folder once");
        item.folder = folder;
        item.where = "--data";
        comparison.data.push_back(std::move(item));
    }
}

MetricSpec read_metric(const std::string& text) {
    MetricSpec metric;
    const std::size_t colon = text.find(':');
    metric.name = text.substr(0, colon);
    const auto wrong = [&]() -> UsageError {
        return UsageError("--metric " + printable(text) +
                          " is none; expected NAME, NAME:lower, NAME:higher or NAME:lower:MARGIN");
    };
    if (metric.name.empty()) throw wrong();
    if (colon == std::string::npos) return metric;
    const std::string rest = text.substr(colon + 1);
    const std::size_t second = rest.find(':');
    const std::string better = rest.substr(0, second);
    if (better != "lower" && better != "higher" && better != "none") throw wrong();
    if (better == "lower") metric.better = Direction::lower;
    if (better == "higher") metric.better = Direction::higher;
    if (second == std::string::npos) return metric;
    const char* end = rest.data() + rest.size();
    const auto read = std::from_chars(rest.data() + second + 1, end, metric.margin);
    if (read.ec != std::errc() || read.ptr != end || metric.margin < 0.0) throw wrong();
    return metric;
}

}  // namespace

void apply(const Selection& selection, Comparison& comparison) {
    apply_folders(selection.folders, comparison);
    if (!selection.only.empty()) apply_only(selection.only, comparison);
    if (!selection.seeds.empty()) {
        std::string why;
        comparison.seeds = read_seeds(selection.seeds, why);
        if (!why.empty()) throw UsageError("--seeds " + why);
        for (DataItem& item : comparison.data) item.seeds.clear();
    }
    if (!selection.metrics.empty()) {
        comparison.metrics.clear();
        for (const std::string& text : selection.metrics) {
            MetricSpec metric = read_metric(text);
            if (has(comparison.metrics, metric.name))
                throw UsageError("--metric " + printable(metric.name) + " is given twice");
            comparison.metrics.push_back(std::move(metric));
        }
    }
    for (Variant& variant : comparison.variants)
        variant.changes.insert(variant.changes.end(), selection.last.begin(), selection.last.end());
}

Comparison quick_comparison(const std::vector<std::filesystem::path>& pipelines) {
    Comparison comparison;
    for (const auto& pipeline : pipelines) {
        Variant variant;
        variant.name = pipeline.stem().string();
        if (has(comparison.variants, variant.name)) variant.name = pipeline.string();
        if (has(comparison.variants, variant.name))
            throw UsageError(pipeline.string() +
                             " is given twice; compare different pipelines, or "
                             "write a comparison file");
        variant.pipeline = pipeline;
        comparison.name += (comparison.name.empty() ? "" : "-") + pipeline.stem().string();
        comparison.variants.push_back(std::move(variant));
    }
    comparison.data.push_back({"pipeline", "", {}, "", {}, {}});
    comparison.seeds = {1};
    return comparison;
}

}  // namespace petal::compare
