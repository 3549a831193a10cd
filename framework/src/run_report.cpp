// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "run_report.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>

namespace petal {

using Json = nlohmann::ordered_json;

namespace {

const char* to_string(RunStatus status) {
    switch (status) {
        case RunStatus::done:
            return "done";
        case RunStatus::failed:
            return "failed";
        case RunStatus::cancelled:
            return "cancelled";
    }
    return "failed";
}

Json notes_json(const std::vector<ToldNote>& notes) {
    Json list = Json::array();
    for (const ToldNote& told : notes) {
        Json entry{{"stage", told.stage}, {"frame", told.frame.number}};
        const auto add = [&entry](const char* key, const std::string& text) {
            if (!text.empty()) entry[key] = text;
        };
        add("frame_name", told.frame.name);
        add("looked_for", told.note.looked_for);
        add("nearest_miss", told.note.nearest_miss);
        add("threshold", told.note.threshold);
        add("hint", told.note.hint);
        list.push_back(std::move(entry));
    }
    return list;
}

Json data_json(const RunReport& report) {
    Json list = Json::array();
    for (const auto& [file, sum] : report.used_files) {
        Json entry{{"file", file.string()}};
        if (sum.missing.empty()) {
            entry["blake2b"] = sum.blake2b;
        } else {
            entry["blake2b"] = nullptr;
            entry["error"] = sum.missing;
        }
        list.push_back(std::move(entry));
    }
    return list;
}

/// The plugins whose stages the pipeline uses.
Json plugins_json(const Pipeline& pipeline) {
    std::set<std::pair<std::string, std::string>> used;
    for (const StageNode& node : pipeline.stages)
        used.insert({node.spec->plugin, node.spec->plugin_version});
    Json list = Json::array();
    for (const auto& [name, its_version] : used)
        list.push_back({{"name", name}, {"version", its_version}});
    return list;
}

}  // namespace

const char* version() {
    return PETAL_VERSION;
}

std::optional<Level> RunReport::level() const {
    if (status != RunStatus::done) return std::nullopt;
    std::optional<Level> worst;
    for (const ToldVerdict& verdict : verdicts)
        worst = std::max(worst.value_or(Level::usable), verdict.level);
    return worst;
}

std::string to_string(const Note& note) {
    std::string text;
    const auto add = [&text](const char* before, const std::string& part) {
        if (part.empty()) return;
        if (!text.empty()) text += "; ";
        text += before + part;
    };
    add("looked for ", note.looked_for);
    add("nearest: ", note.nearest_miss);
    add("threshold: ", note.threshold);
    add("try: ", note.hint);
    return text;
}

void add_checksums(RunReport& report, Checksums& checksums, const std::atomic<bool>* cancel) {
    report.used_files = checksums.finish();
    if (cancel != nullptr && cancel->load() && report.status == RunStatus::done)
        report.status = RunStatus::cancelled;
}

std::string to_json(const RunReport& report, const Pipeline& pipeline) {
    Json verdicts = Json::array();
    for (const ToldVerdict& told : report.verdicts)
        verdicts.push_back({{"stage", told.stage},
                            {"level", petal::to_string(told.level)},
                            {"reasons", told.reasons}});
    Json products = Json::array();
    for (const auto& product : report.products) products.push_back(product.string());
    Json stages = Json::object();
    for (const StageNode& node : pipeline.stages) {
        const auto found = report.stages.find(node.id);
        const StageStatistics s = found == report.stages.end() ? StageStatistics{} : found->second;
        stages[node.id] = {{"type", node.spec->type}, {"firings", s.firings},
                           {"packets", s.packets},    {"bytes", s.bytes},
                           {"wall_s", s.wall_s},      {"cpu_s", s.cpu_s}};
    }
    Json root{{"petal_run", 1},
              {"status", to_string(report.status)},
              {"verdict", report.level() ? Json(petal::to_string(*report.level())) : Json()},
              {"verdicts", std::move(verdicts)},
              {"errors", report.errors},
              {"notes", notes_json(report.notes)},
              {"seed", pipeline.seed},
              {"threads", report.threads},
              {"frames", report.frames},
              {"versions", {{"petal", version()}, {"plugins", plugins_json(pipeline)}}},
              {"data", data_json(report)},
              {"products", std::move(products)},
              {"wall_s", report.wall_s},
              {"cpu_s", report.cpu_s},
              {"peak_memory_bytes", report.peak_memory_bytes},
              {"stages", std::move(stages)},
              {"pipeline", Json::parse(pipeline.effective_json)}};
    // A path or message need not be UTF-8: replaced, not thrown at.
    return root.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace petal
