// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "command.hpp"

#include <algorithm>
#include <iostream>

#include "nearest.hpp"

namespace petal::cli {

Verbosity GlobalOptions::verbosity() const {
    if (quiet) return Verbosity::quiet;
    return verbose ? Verbosity::verbose : Verbosity::normal;
}

void PipelineOptions::add_to(CLI::App& command) {
    command.add_option("PIPELINE", pipeline, "pipeline file (JSON)")->required();
    add_options_to(command);
}

void PipelineOptions::add_options_to(CLI::App& command) {
    command
        .add_option("--with", with,
                    "patch (RFC 7396 merge patch) applied to the pipeline; repeatable")
        ->allow_extra_args(false);
    command.add_option("--set", set, "STAGE.PARAM=JSON: one parameter, applied last; repeatable")
        ->allow_extra_args(false);
    command.add_option("--data", data, "folder that ${data} stands for");
    command.add_option("--out", out, "run folder (default: runs/<pipeline>-<UTC time>)");
    command.add_option("--seed", seed, "seed of all randomness (default: the pipeline's)")
        ->check(CLI::NonNegativeNumber);
    command.add_option("--threads", threads, "threads (default: as many as cores)")
        ->check(CLI::Range(1, 1024));
    command.add_option("--debug", debug, "stage id, or all: keep its debug files; repeatable")
        ->allow_extra_args(false);
    command.add_flag("--force", force, "replace the run that --out holds");
}

PipelineRequest PipelineOptions::request() const {
    PipelineRequest request;
    request.file = pipeline;
    request.patches = with;
    request.sets = set;
    request.seed = seed;
    if (!data.empty()) request.data = data;
    if (!out.empty()) request.out = out;
    return request;
}

PluginSet find_plugins(const GlobalOptions& global) {
    return load_plugins(plugin_folders(global.plugin_path));
}

std::optional<Pipeline> checked(const PipelineRequest& request, const PluginSet& plugins,
                                int& exit_code) {
    CheckedPipeline read = read_pipeline(request, plugins.registry);
    if (read.pipeline) return std::move(read.pipeline);
    bool missing_type = false;
    for (const Problem& problem : read.problems) {
        std::cerr << to_string(problem) << "\n";
        missing_type = missing_type || problem.missing_type;
    }
    exit_code = kWrongUsage;
    if (missing_type && !plugins.refused.empty()) {
        exit_code = kMissingPlugin;
        std::cerr << "libraries that were refused and may hold the missing type:\n";
        for (const Refusal& refusal : plugins.refused)
            std::cerr << "  " << refusal.library.string() << ": " << refusal.reason << "\n";
    }
    std::cerr << read.problems.size() << (read.problems.size() == 1 ? " problem" : " problems")
              << "; nothing was run\n";
    return std::nullopt;
}

bool debug_ids_known(const std::vector<std::string>& ids, const Pipeline& pipeline) {
    bool all_known = true;
    for (const std::string& id : ids) {
        if (id == "all" || pipeline.find(id) != nullptr) continue;
        std::vector<std::string> known;
        for (const StageNode& node : pipeline.stages) known.push_back(node.id);
        std::cerr << "--debug " << id << ": the pipeline has no stage of that id"
                  << did_you_mean(id, known) << "\n";
        all_known = false;
    }
    return all_known;
}

}  // namespace petal::cli
