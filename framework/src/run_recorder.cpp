// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "run_recorder.hpp"

#include <algorithm>
#include <utility>

#include "run_folder.hpp"

namespace petal {

void RunRecorder::log(const std::string& stage, LogLevel level, const std::string& message) {
    log_.write(level, "[" + stage + "] " + message);
}

void RunRecorder::note(const std::string& stage, const FrameInfo& frame, const Note& note) {
    const std::string where = frame.name.empty() ? "" : " (" + frame.name + ")";
    log(stage, LogLevel::warning, to_string(note) + where);
    const std::lock_guard<std::mutex> lock(mutex_);
    notes_.push_back({stage, frame, note});
}

void RunRecorder::verdict(const std::string& stage, Level level,
                          const std::vector<std::string>& reasons) {
    const std::lock_guard<std::mutex> lock(mutex_);
    verdicts_.push_back({stage, level, reasons});
}

void RunRecorder::progress(const std::string& stage, double done, double total,
                           std::string_view unit) {
    const std::lock_guard<std::mutex> lock(mutex_);
    progress_[stage] = {done, total, std::string(unit)};
}

SourceProgress RunRecorder::progress_of(const std::string& stage) const {
    const std::lock_guard<std::mutex> lock(mutex_);
    const auto found = progress_.find(stage);
    return found == progress_.end() ? SourceProgress{} : found->second;
}

void RunRecorder::used_file(const std::filesystem::path& path) {
    if (settings_.checksums != nullptr) settings_.checksums->add(path.lexically_normal());
    const std::lock_guard<std::mutex> lock(mutex_);
    used_paths_.insert(path.lexically_normal());
}

void RunRecorder::claim_product(const std::string& stage, const std::filesystem::path& name) {
    const std::string first = name.begin()->string();
    if (first == "run.json" || first == "log.txt" || first == "stages" || first[0] == '.')
        throw Error("'" + name.string() +
                    "' is the run's own name; choose another for the product");
    const std::lock_guard<std::mutex> lock(mutex_);
    const auto [taken, is_new] = products_.emplace(name, stage);
    if (!is_new)
        throw Error("'" + name.string() + "' is written by stage '" + taken->second +
                    "' already; give each product a name of its own");
    note_product(settings_.folder, name);
}

bool RunRecorder::debug(const std::string& stage) const {
    return settings_.debug.count("all") > 0 || settings_.debug.count(stage) > 0;
}

bool RunRecorder::cancelled() const {
    return settings_.cancel != nullptr && settings_.cancel->load();
}

void RunRecorder::fill(RunReport& report, const Pipeline& pipeline) {
    std::map<std::string, std::size_t> rank;
    for (const StageNode& node : pipeline.stages) rank.emplace(node.id, rank.size());
    std::stable_sort(notes_.begin(), notes_.end(), [&](const ToldNote& a, const ToldNote& b) {
        return std::make_pair(rank[a.stage], a.frame.number) <
               std::make_pair(rank[b.stage], b.frame.number);
    });
    std::stable_sort(
        verdicts_.begin(), verdicts_.end(),
        [&](const ToldVerdict& a, const ToldVerdict& b) { return rank[a.stage] < rank[b.stage]; });
    report.notes = std::move(notes_);
    report.verdicts = std::move(verdicts_);
    report.used_paths = std::move(used_paths_);
    for (const auto& [name, stage] : products_) report.products.push_back(name);
}

}  // namespace petal
