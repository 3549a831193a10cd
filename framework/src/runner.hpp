// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "checksums.hpp"
#include "firing_tape.hpp"
#include "pipeline.hpp"
#include "run_log.hpp"
#include "run_progress.hpp"
#include "run_report.hpp"

namespace petal {

struct RunSettings {
    int threads = 1;               ///< at least 1
    std::set<std::string> debug;   ///< stage ids; "all" means every one
    std::filesystem::path folder;  ///< prepared with prepare_run_folder()
    /// Told the number of threads before the first stage fires (PluginSet::thread_limits).
    std::vector<std::function<void(int)>> thread_limits;
    /// Told a few times a second how far the run is, on a thread of its own. May be empty.
    std::function<void(const RunProgress&)> on_progress;
    Checksums* checksums = nullptr;             ///< given the files that stages use; may be null
    const std::atomic<bool>* cancel = nullptr;  ///< set from a signal handler; may be null
    /// By stage id: stages that do not fire, since another run has done the same; and tapes to fill
    /// for later runs. A stage is in one of them at most.
    std::map<std::string, const FiringTape*> played;
    std::map<std::string, FiringTape*> taped;
};

/// Runs a checked pipeline: stages as tasks over the graph, each instance in frame order on one
/// thread at a time, branches and frames in parallel, a bounded number of frames in flight.
/// Exceptions of stages end the run and stand in the report's errors; this throws only for its own
/// faults.
RunReport run_pipeline(const Pipeline& pipeline, const RunSettings& settings, RunLog& log);

}  // namespace petal
