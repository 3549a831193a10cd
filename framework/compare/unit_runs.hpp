// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <atomic>
#include <functional>
#include <string>
#include <vector>

#include "group_runner.hpp"
#include "plan.hpp"
#include "unit_store.hpp"

namespace petal::compare {

/// How far a comparison is.
struct UnitProgress {
    std::size_t done = 0;  ///< of those that have to be run
    std::size_t of = 0;
    std::size_t failed = 0;
    double elapsed_s = 0.0;
};
std::string to_string(const UnitProgress& progress);

struct UnitRunSettings {
    std::filesystem::path out;
    int jobs = 1;       ///< processes at a time
    bool share = true;  ///< stages that variants have in common
    const std::atomic<bool>* cancel = nullptr;
    std::function<void(const UnitProgress&)> on_progress;
    std::function<void(const std::string&)> tell;  ///< a line about something unusual
    /// After each group, with all records there are: throws to stop.
    std::function<void(const std::map<std::string, UnitRecord>&)> check;
};

/// What became of the units of a plan.
struct UnitRuns {
    std::map<std::string, UnitRecord> records;  ///< by key
    std::size_t reused = 0;                     ///< were there already
    bool cancelled = false;
};

/// Runs all units that are not there yet: a process for each group, `jobs` of them at a time. A
/// unit that crashes is recorded, and the rest of its group goes on. \throws Error where the disk
/// fails, or whatever `check` throws; what is finished stays.
UnitRuns run_units(const Comparison& comparison, const Plan& plan, const PluginSet& plugins,
                   FileSums& sums, const UnitRunSettings& settings);

}  // namespace petal::compare
