// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include <algorithm>
#include <nlohmann/json.hpp>
#include <utility>

#include "report.hpp"

namespace petal::compare {

using Json = nlohmann::ordered_json;

namespace {

Json median_json(std::vector<double> values) {
    if (values.empty()) return nullptr;
    return median_of(std::move(values));
}

/// The measured units of one variant.
struct Times {
    std::size_t failed = 0;
    std::vector<double> wall_s;
    std::vector<double> cpu_s;
    std::vector<double> wall_ratio;  ///< to the reference on the same data and seed
    std::uint64_t peak_memory_bytes = 0;
    std::map<std::string, std::vector<double>> stages;
};

Times times_of(const Comparison& comparison, const Plan& plan,
               const std::map<std::string, UnitRecord>& records, std::size_t variant) {
    std::map<std::pair<std::size_t, std::uint64_t>, double> reference;
    const auto record_of = [&](const Unit& unit) -> const UnitRecord* {
        const auto found = records.find(unit.key);
        return found == records.end() ? nullptr : &found->second;
    };
    for (const Unit& unit : plan.units) {
        const UnitRecord* record = record_of(unit);
        if (unit.variant == comparison.reference && record != nullptr && record->status == "done")
            reference[{unit.data, unit.seed}] = record->wall_s;
    }
    Times times;
    for (const Unit& unit : plan.units) {
        const UnitRecord* record = record_of(unit);
        if (unit.variant != variant || record == nullptr) continue;
        if (record->status != "done") {
            ++times.failed;
            continue;
        }
        times.wall_s.push_back(record->wall_s);
        times.cpu_s.push_back(record->cpu_s);
        times.peak_memory_bytes = std::max(times.peak_memory_bytes, record->peak_memory_bytes);
        for (const auto& [id, wall_s] : record->stage_wall_s) times.stages[id].push_back(wall_s);
        const auto other = reference.find({unit.data, unit.seed});
        if (other != reference.end() && other->second > 0.0)
            times.wall_ratio.push_back(record->wall_s / other->second);
    }
    return times;
}

}  // namespace

std::string timing_json(const Comparison& comparison, const Plan& plan,
                        const std::map<std::string, UnitRecord>& records, double load_before,
                        double load_after) {
    Json variants = Json::object();
    for (std::size_t v = 0; v < comparison.variants.size(); ++v) {
        const Times times = times_of(comparison, plan, records, v);
        Json stages = Json::object();
        for (const auto& [id, wall_s] : times.stages) stages[id] = median_json(wall_s);
        variants[comparison.variants[v].name] = {
            {"units", times.wall_s.size()},
            {"failed", times.failed},
            {"median_wall_s", median_json(times.wall_s)},
            {"median_cpu_s", median_json(times.cpu_s)},
            {"median_wall_ratio_to_reference", median_json(times.wall_ratio)},
            {"peak_memory_bytes", times.peak_memory_bytes},
            {"median_stage_wall_s", std::move(stages)}};
    }
    const Json root{{"petal_timing", 1},
                    {"name", comparison.name},
                    {"how", "one unit after the other, one thread, nothing shared"},
                    {"reference", comparison.variants[comparison.reference].name},
                    {"load_average_before", load_before},
                    {"load_average_after", load_after},
                    {"variants", std::move(variants)}};
    return root.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace petal::compare
