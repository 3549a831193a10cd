// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "loader.hpp"
#include "pipeline.hpp"
#include "run_log.hpp"

namespace petal::cli {

/// The exit codes of the contract.
enum ExitCode {
    kDone = 0,
    kRunFailed = 1,
    kWrongUsage = 2,     ///< wrong pipeline or usage
    kMissingPlugin = 3,  ///< a needed type is missing and a library was refused
    kNotUsable = 4,      ///< it ran; the result is weak or not usable
    kCancelled = 130,
};

struct GlobalOptions {
    std::vector<std::filesystem::path> plugin_path;
    bool quiet = false;
    bool verbose = false;

    Verbosity verbosity() const;
};

/// What run, check and show have in common.
struct PipelineOptions {
    std::filesystem::path pipeline;
    std::vector<std::filesystem::path> with;
    std::vector<std::string> set;
    std::string data;
    std::string out;
    std::optional<std::uint64_t> seed;
    int threads = 0;  ///< 0: as many as there are cores
    std::vector<std::string> debug;
    bool force = false;

    void add_to(CLI::App& command);
    /// All but the pipeline itself, for a command that brings its own.
    void add_options_to(CLI::App& command);
    PipelineRequest request() const;
};

/// A sub-command sets this to its work when it was chosen.
using Action = std::function<int()>;

void add_run(CLI::App& app, const GlobalOptions& global, Action& action);
void add_check(CLI::App& app, const GlobalOptions& global, Action& action);
void add_show(CLI::App& app, const GlobalOptions& global, Action& action);
void add_stages(CLI::App& app, const GlobalOptions& global, Action& action);
void add_plugins(CLI::App& app, const GlobalOptions& global, Action& action);
void add_inspect(CLI::App& app, const GlobalOptions& global, Action& action);
void add_verify(CLI::App& app, const GlobalOptions& global, Action& action);
void add_compare(CLI::App& app, const GlobalOptions& global, Action& action);
void add_schema(CLI::App& app, const GlobalOptions& global, Action& action);

/// Loads all plugins of the search path. \throws Error on an unusable search path or a stage type
/// twice.
PluginSet find_plugins(const GlobalOptions& global);

/// Reads and checks; on problems tells all of them on standard error and gives the exit code
/// instead.
std::optional<Pipeline> checked(const PipelineRequest& request, const PluginSet& plugins,
                                int& exit_code);

/// Runs a pipeline as `petal run` does; the exit code.
int run_pipeline_file(const PipelineOptions& options, const GlobalOptions& global);

/// Ids given with --debug that the pipeline does not have: told on standard error. True when all
/// are known.
bool debug_ids_known(const std::vector<std::string>& ids, const Pipeline& pipeline);

}  // namespace petal::cli
