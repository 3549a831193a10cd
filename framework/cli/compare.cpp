// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include <algorithm>
#include <csignal>
#include <iostream>
#include <memory>
#include <thread>

#include "command.hpp"
#include "compare_run.hpp"
#include "comparison_reader.hpp"
#include "host_errors.hpp"
#include "interrupt.hpp"
#include "progress_terminal.hpp"
#include "run_folder.hpp"
#include "selection.hpp"

namespace petal::cli {

namespace {

struct CompareOptions {
    std::vector<std::filesystem::path> files;
    std::string out;
    std::vector<std::string> with;
    std::vector<std::string> set;
    compare::Selection selection;
    int jobs = 0;
    std::size_t timing = 0;
    bool no_sharing = false;
    bool check = false;
};

/// Problems on standard error; nothing is run where there are any.
int told(const std::vector<Problem>& problems) {
    for (const Problem& problem : problems) std::cerr << to_string(problem) << "\n";
    std::cerr << problems.size() << (problems.size() == 1 ? " problem" : " problems")
              << "; nothing was run\n";
    return kWrongUsage;
}

/// One file is a comparison; several are pipelines, against the first of them.
std::optional<compare::Comparison> read(const CompareOptions& options, int& code) {
    if (options.files.size() > 1) return compare::quick_comparison(options.files);
    auto checked = compare::read_comparison(options.files.front());
    if (!checked.comparison) code = told(checked.problems);
    return std::move(checked.comparison);
}

int told_of_pipelines(const compare::Plan& plan, const PluginSet& plugins) {
    const int code = told(plan.problems);
    if (!plan.missing_type || plugins.refused.empty()) return code;
    std::cerr << "libraries that were refused and may hold the missing type:\n";
    for (const Refusal& refusal : plugins.refused)
        std::cerr << "  " << refusal.library.string() << ": " << refusal.reason << "\n";
    return kMissingPlugin;
}

int run_planned(const CompareOptions& options, const GlobalOptions& global,
                const compare::Comparison& comparison, const compare::Plan& plan,
                const PluginSet& plugins, compare::FileSums& sums) {
    const compare::OutFolder out(options.out.empty() ? default_run_folder(comparison.name)
                                                     : std::filesystem::path(options.out),
                                 comparison, plan);
    ProgressTerminal terminal(!global.quiet && stderr_takes_status());
    compare::CompareSettings settings;
    settings.jobs = options.jobs > 0
                        ? options.jobs
                        : static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
    settings.share = !options.no_sharing;
    settings.timing_seeds = options.timing;
    settings.cancel = &catch_interrupts();
    settings.tell = [&](const std::string& line) {
        if (!global.quiet) terminal.print(line + "\n");
    };
    settings.on_progress = [&](const compare::UnitProgress& progress, const std::string& what) {
        const std::string text = what + compare::to_string(progress);
        if (terminal.width() > 0) terminal.set_status(text.substr(0, terminal.width()));
    };
    const auto end = compare::run_comparison(comparison, plan, plugins, sums, out, settings);
    terminal.set_status("");
    if (end.cancelled)
        std::cout << "cancelled; the same command goes on from here\n";
    else
        std::cout << end.table;
    std::cout << "comparison folder: " << out.path().string() << "\n";
    if (end.cancelled) return kCancelled;
    if (!end.all_failed) return kDone;
    std::cerr << "petal: every unit failed, so nothing was compared; compare.json lists the "
                 "reasons under failed_units\n";
    return kRunFailed;
}

int compare_command(CompareOptions& options, const GlobalOptions& global) {
    // A limit on the size of files is an error of the write, like a full disk, not the end.
    std::signal(SIGXFSZ, SIG_IGN);
    end_on_interrupt();
    const PluginSet plugins = find_plugins(global);
    int code = kDone;
    auto comparison = read(options, code);
    if (!comparison) return code;
    for (const std::string& file : options.with)
        options.selection.last.push_back(PipelineChange::of_file(file));
    for (const std::string& set : options.set)
        options.selection.last.push_back(PipelineChange::of_set(set));
    compare::apply(options.selection, *comparison);
    compare::FileSums sums;
    const compare::Plan plan = compare::make_plan(*comparison, plugins, sums);
    if (!plan.problems.empty()) return told_of_pipelines(plan, plugins);
    if (!options.check) return run_planned(options, global, *comparison, plan, plugins, sums);
    if (!global.quiet)
        std::cout << comparison->name << ": " << comparison->variants.size() << " variants, "
                  << comparison->data.size() << " data, " << plan.units.size()
                  << " units, no problem found\n";
    return kDone;
}

}  // namespace

void add_compare(CLI::App& app, const GlobalOptions& global, Action& action) {
    auto options = std::make_shared<CompareOptions>();
    CLI::App* command = app.add_subcommand(
        "compare", "compare variants of a pipeline over data and seeds: which is better, how sure");
    command
        ->add_option("FILE", options->files,
                     "a comparison file; or two pipelines and more, compared with the first")
        ->required();
    command->add_option("--out", options->out,
                        "folder of the comparison; one that holds it goes on from there");
    compare::Selection& selection = options->selection;
    const auto repeatable = [&](const char* name, auto& target, const char* help) {
        command->add_option(name, target, help)->allow_extra_args(false);
    };
    repeatable("--data", selection.folders, "data folder, in place of the file's data; repeatable");
    command->add_option("--seeds", selection.seeds, "1..20, or 1..5,8: in place of the file's");
    repeatable("--metric", selection.metrics,
               "NAME[:lower|higher|none[:MARGIN]], in place of the file's; repeatable");
    repeatable("--only", selection.only,
               "name of a variant (the reference stays) or data item; repeatable");
    repeatable("--with", options->with, "patch applied to every variant, last; repeatable");
    repeatable("--set", options->set,
               "STAGE.PARAM=JSON, applied to every variant, last; repeatable");
    command->add_option("--jobs", options->jobs, "units at a time (default: as many as cores)")
        ->check(CLI::Range(1, 1024));
    command
        ->add_option("--timing", options->timing,
                     "then measure times, one unit after the other, on that many seeds of each "
                     "data item")
        ->check(CLI::Range(1, 100000));
    command->add_flag("--no-sharing", options->no_sharing,
                      "execute every stage in every unit, also what variants have in common");
    command->add_flag("--check", options->check, "all checks that need no run, and no more");
    command->callback([options, &global, &action] {
        action = [options, &global] { return compare_command(*options, global); };
    });
}

}  // namespace petal::cli
