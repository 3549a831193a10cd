// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "group_runner.hpp"

#include <algorithm>
#include <system_error>
#include <utility>

#include "param_values.hpp"
#include "pipeline_reader.hpp"
#include "runner.hpp"
#include "text_file.hpp"

namespace petal::compare {

namespace fs = std::filesystem;

namespace {

/// A message of a run without the folders that differ from one machine to the next.
std::string without_folders(std::string text, const fs::path& work, const fs::path& data) {
    const auto replace = [&text](const std::string& folder, const std::string& name) {
        if (folder.empty()) return;
        for (std::size_t at = text.find(folder); at != std::string::npos;
             at = text.find(folder, at + name.size()))
            text.replace(at, folder.size(), name);
    };
    replace(work.string(), "${out}");
    replace(data.string(), "${data}");
    return text;
}

/// What stages drew, by path below their folder with '-' for '/': the first few by name that are
/// not large, since there may be many units.
std::map<std::string, std::string> pictures_in(const fs::path& folder) {
    constexpr std::size_t kMost = 4;
    constexpr std::uintmax_t kLargest = 2000000;  // bytes
    std::vector<fs::path> files;
    std::error_code error;
    for (fs::recursive_directory_iterator entry(folder, error), end; !error && entry != end;
         entry.increment(error)) {
        const fs::path kind = entry->path().extension();
        std::error_code none;
        if ((kind == ".png" || kind == ".jpg") && entry->is_regular_file(none) &&
            entry->file_size(none) <= kLargest)
            files.push_back(entry->path());
    }
    std::sort(files.begin(), files.end());
    if (files.size() > kMost) files.resize(kMost);
    std::map<std::string, std::string> pictures;
    for (const fs::path& file : files) {
        std::string name = file.lexically_relative(folder).generic_string();
        std::replace(name.begin(), name.end(), '/', '-');
        std::string why;
        if (auto bytes = read_text_file(file, why)) pictures[name] = std::move(*bytes);
    }
    return pictures;
}

std::string key_text(const Pipeline& pipeline, const StageNode& stage,
                     const std::map<std::string, std::string>& upstream) {
    std::string text = stage.id + "\n" + stage.spec->type + "\n" + std::to_string(pipeline.seed);
    for (const auto& [name, value] : stage.values) text += "\n" + name + "=" + value_text(value);
    for (const auto& [port, wires] : stage.inputs)
        for (const Wire& wire : wires)
            text += "\n" + port + "<-" + upstream.at(wire.stage) + "." + wire.port;
    return text;
}

}  // namespace

std::map<std::string, std::string> sharing_keys(const Pipeline& pipeline) {
    std::map<std::string, std::string> keys;
    for (const StageNode& stage : pipeline.stages) {
        if (stage.spec->outputs.empty()) continue;  // nothing reads from a sink
        keys[stage.id] = blake2b_of_text(key_text(pipeline, stage, keys));
    }
    return keys;
}

GroupRunner::Prepared GroupRunner::prepare(const Unit& unit) const {
    const PlannedPipeline& planned = plan_.pipelines[unit.variant][unit.data];
    Prepared prepared;
    prepared.unit = &unit;
    prepared.folder = work_ / unit.key;
    PipelineRequest request;
    request.file = planned.name;
    request.seed = unit.seed;
    request.out = prepared.folder;
    const fs::path& data = plan_.data[unit.data].folder;
    if (!data.empty()) request.data = data;
    CheckedPipeline checked =
        read_pipeline_texts({planned.name, planned.text}, {}, request, plugins_.registry);
    if (!checked.pipeline)
        throw Error("the effective pipeline of variant " + comparison_.variants[unit.variant].name +
                    " is refused: " + to_string(checked.problems.front()));
    prepared.pipeline = std::move(*checked.pipeline);
    if (share_) prepared.keys = sharing_keys(prepared.pipeline);
    return prepared;
}

void GroupRunner::run(const std::vector<std::size_t>& units,
                      const std::function<void(const UnitRecord&)>& finished) {
    std::vector<Prepared> all;
    all.reserve(units.size());
    for (const std::size_t unit : units) all.push_back(prepare(plan_.units[unit]));
    wanted_.clear();
    tapes_.clear();
    for (const Prepared& prepared : all)
        for (const auto& [id, key] : prepared.keys) ++wanted_[key];
    for (const Prepared& prepared : all) {
        for (const auto& [id, key] : prepared.keys) --wanted_[key];
        finished(run_one(prepared));
        for (auto tape = tapes_.begin(); tape != tapes_.end();) {
            const bool useless = wanted_[tape->first] == 0 || !tape->second.can_be_played();
            tape = useless ? tapes_.erase(tape) : std::next(tape);
        }
    }
}

UnitRecord GroupRunner::run_one(const Prepared& prepared) {
    std::error_code error;
    fs::remove_all(prepared.folder, error);
    fs::create_directories(prepared.folder, error);
    if (error)
        throw WriteError("cannot make the folder " + prepared.folder.string() + ": " +
                         error.message());
    RunSettings settings;
    settings.folder = prepared.folder;
    settings.thread_limits = plugins_.thread_limits;
    for (const auto& [id, key] : prepared.keys) {
        const auto tape = tapes_.find(key);
        if (tape != tapes_.end()) {
            settings.played[id] = &tape->second;
        } else if (wanted_[key] > 0) {
            settings.taped[id] = &tapes_[key];
        }
    }
    RunReport report;
    {
        RunLog log(prepared.folder, Verbosity::quiet);
        report = run_pipeline(prepared.pipeline, settings, log);
    }
    if (report.write_failed)
        throw WriteError(report.errors.empty() ? "cannot write" : report.errors.front());
    UnitRecord record = record_of(prepared, report);
    for (const StageNode& stage : prepared.pipeline.stages) {
        const bool shared = settings.played.count(stage.id) > 0;
        (shared ? record.shared : record.executed).push_back(stage.id);
        const auto figures = report.stages.find(stage.id);
        if (!shared && figures != report.stages.end())
            record.stage_wall_s[stage.id] = figures->second.wall_s;
    }
    for (const fs::path& file : report.used_paths) {
        const fs::path absolute = fs::absolute(file).lexically_normal();
        record.files[absolute.string()] = sums_.of_any(absolute);
    }
    if (record.status != "done" || record.verdict == petal::to_string(Level::not_usable))
        record.pictures = pictures_in(prepared.folder / "stages");
    fs::remove_all(prepared.folder, error);
    return record;
}

UnitRecord GroupRunner::record_of(const Prepared& prepared, const RunReport& report) const {
    UnitRecord record;
    record.key = prepared.unit->key;
    record.variant = comparison_.variants[prepared.unit->variant].name;
    record.data = comparison_.data[prepared.unit->data].name;
    record.seed = prepared.unit->seed;
    record.status = report.status == RunStatus::done ? "done" : "error";
    std::vector<std::string> reasons = report.errors;
    if (const auto level = report.level()) {
        record.verdict = petal::to_string(*level);
        for (const ToldVerdict& told : report.verdicts)
            reasons.insert(reasons.end(), told.reasons.begin(), told.reasons.end());
    }
    for (const std::string& reason : reasons)
        record.reasons.push_back(
            without_folders(reason, prepared.folder, plan_.data[prepared.unit->data].folder));
    record.wall_s = report.wall_s;
    record.cpu_s = report.cpu_s;
    record.peak_memory_bytes = report.peak_memory_bytes;
    if (report.status != RunStatus::done ||
        std::count(report.products.begin(), report.products.end(), "result.json") == 0)
        return record;
    std::string why;
    const fs::path result = prepared.folder / "result.json";
    if (auto text = read_text_file(result, why)) {
        record.result = std::move(*text);
    } else {
        record.status = "error";
        record.reasons.push_back("result.json " + why);
    }
    return record;
}

}  // namespace petal::compare
