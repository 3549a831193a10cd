// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "checksums.hpp"
#include "petal/run.hpp"
#include "pipeline.hpp"

namespace petal {

/// What one stage did in a run.
struct StageStatistics {
    std::uint64_t firings = 0;
    std::uint64_t packets = 0;  ///< written
    std::uint64_t bytes = 0;    ///< of them
    double wall_s = 0.0;
    double cpu_s = 0.0;  ///< of the stage's own thread
};

struct ToldNote {
    std::string stage;
    FrameInfo frame;
    Note note;
};

struct ToldVerdict {
    std::string stage;
    Level level = Level::usable;
    std::vector<std::string> reasons;
};

/// How a run ended.
enum class RunStatus { done, failed, cancelled };

/// All that a run tells: the content of run.json.
struct RunReport {
    RunStatus status = RunStatus::done;
    std::vector<std::string> errors;  ///< one sentence each: stage, type, frame, what
    std::vector<ToldNote> notes;      ///< by stage in topological order, then by frame
    std::vector<ToldVerdict> verdicts;
    std::map<std::string, StageStatistics> stages;
    std::map<std::filesystem::path, Checksum> used_files;  ///< by add_checksums()
    std::set<std::filesystem::path> used_paths;            ///< the same files, as they were told
    std::vector<std::filesystem::path> products;           ///< relative to the run folder, sorted
    std::uint64_t frames = 0;
    int threads = 1;
    double wall_s = 0.0;
    double cpu_s = 0.0;
    std::uint64_t peak_memory_bytes = 0;
    bool write_failed = false;  ///< an error is the disk's, not the pipeline's

    /// The worst level told. None where no stage judged, or the run did not come to its end.
    std::optional<Level> level() const;
};

/// One line for a note: what was looked for, the nearest miss, the threshold, the hint.
std::string to_string(const Note& note);

/// Waits for the checksums of the used files. Where the run is cancelled meanwhile, the status of
/// one that was done becomes cancelled.
void add_checksums(RunReport& report, Checksums& checksums, const std::atomic<bool>* cancel);

/// run.json. A used file without a checksum has null and the reason.
std::string to_json(const RunReport& report, const Pipeline& pipeline);

/// The version of petal, e.g. "0.1.0".
const char* version();

}  // namespace petal
