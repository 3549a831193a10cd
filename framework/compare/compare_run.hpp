// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <atomic>
#include <filesystem>
#include <functional>
#include <string>

#include "comparison.hpp"
#include "loader.hpp"
#include "out_folder.hpp"
#include "plan.hpp"
#include "unit_runs.hpp"

namespace petal::compare {

struct CompareSettings {
    int jobs = 1;
    bool share = true;
    std::size_t timing_seeds = 0;  ///< seeds of each data item in the serial timing pass; 0: none
    const std::atomic<bool>* cancel = nullptr;
    std::function<void(const UnitProgress&, const std::string& what)> on_progress;
    std::function<void(const std::string&)> tell;
};

struct CompareEnd {
    bool cancelled = false;
    std::string table;        ///< for the terminal
    bool all_failed = false;  ///< no unit of any variant succeeded: nothing was compared
};

/// Runs what is not there yet, and writes compare.json, report.html, metrics/*.csv, timing.json and
/// run.json into the folder. \throws UsageError (metrics that no result has), Error (disk).
CompareEnd run_comparison(const Comparison& comparison, const Plan& plan, const PluginSet& plugins,
                          FileSums& sums, const OutFolder& out, const CompareSettings& settings);

}  // namespace petal::compare
