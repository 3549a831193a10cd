// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include <atomic>
#include <csignal>
#include <iostream>
#include <thread>

#include "command.hpp"
#include "host_errors.hpp"
#include "petal/output.hpp"
#include "run_folder.hpp"
#include "run_report.hpp"
#include "runner.hpp"

namespace petal::cli {

namespace {

std::atomic<bool> cancel_requested{false};
static_assert(std::atomic<bool>::is_always_lock_free, "written from a signal handler");

/// The first signal asks the run to end; a second one ends the program at once.
extern "C" void on_signal(int number) {
    cancel_requested.store(true);
    std::signal(number, SIG_DFL);
}

int thread_count(int asked) {
    if (asked > 0) return asked;
    return static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
}

/// What the user reads at the end of a run.
void print_summary(const RunReport& report, const std::filesystem::path& folder) {
    if (report.status == RunStatus::cancelled) std::cout << "cancelled\n";
    if (const auto level = report.level()) {
        std::cout << "verdict: " << to_string(*level) << "\n";
        for (const ToldVerdict& verdict : report.verdicts)
            for (const std::string& reason : verdict.reasons) std::cout << "  - " << reason << "\n";
    }
    if (report.status == RunStatus::done)
        for (const auto& product : report.products)
            std::cout << "product: " << (folder / product).string() << "\n";
    std::cout << "run folder: " << folder.string() << "\n";
}

int exit_code(const RunReport& report) {
    if (report.status == RunStatus::cancelled) return kCancelled;
    if (report.status == RunStatus::failed) return kRunFailed;
    return report.level().value_or(Level::usable) == Level::usable ? kDone : kNotUsable;
}

int run(const PipelineOptions& options, const GlobalOptions& global) {
    const PluginSet plugins = find_plugins(global);
    PipelineRequest request = options.request();
    request.need_data = true;
    if (!request.out) request.out = default_run_folder(request.file.stem().string());
    request.out = std::filesystem::absolute(*request.out);
    if (request.data) {
        std::error_code ignored;
        if (!std::filesystem::is_directory(*request.data, ignored))
            throw UsageError("--data " + request.data->string() +
                             " is no folder; give the folder that holds the data");
        request.data = std::filesystem::absolute(*request.data);
    }
    int code = kDone;
    const auto pipeline = checked(request, plugins, code);
    if (!pipeline) return code;
    if (!debug_ids_known(options.debug, *pipeline)) return kWrongUsage;

    RunSettings settings;
    settings.threads = thread_count(options.threads);
    settings.debug.insert(options.debug.begin(), options.debug.end());
    settings.folder = prepare_run_folder(*request.out, options.force,
                                         RunInputs{request.data.value_or(""), request.file});
    settings.thread_limits = plugins.thread_limits;
    settings.cancel = &cancel_requested;
    std::signal(SIGINT, on_signal);
    std::signal(SIGTERM, on_signal);

    RunLog log(settings.folder, global.verbosity());
    const RunReport report = run_pipeline(*pipeline, settings, log);
    for (const std::string& error : report.errors) log.error(error);
    log.close();
    PendingFile run_json(settings.folder / "run.json");
    write_file(run_json.path(), to_json(report, *pipeline));
    run_json.commit();
    print_summary(report, settings.folder);
    return exit_code(report);
}

}  // namespace

void add_run(CLI::App& app, const GlobalOptions& global, Action& action) {
    auto options = std::make_shared<PipelineOptions>();
    CLI::App* command = app.add_subcommand("run", "run a pipeline into a run folder");
    options->add_to(*command);
    command->callback([options, &global, &action] {
        action = [options, &global] { return run(*options, global); };
    });
}

}  // namespace petal::cli
