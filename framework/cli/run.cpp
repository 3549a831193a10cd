// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include <atomic>
#include <csignal>
#include <iostream>
#include <thread>
#include <utility>

#include "command.hpp"
#include "host_errors.hpp"
#include "interrupt.hpp"
#include "petal/output.hpp"
#include "run_folder.hpp"
#include "run_guard.hpp"
#include "run_progress.hpp"
#include "run_report.hpp"
#include "runner.hpp"

namespace petal::cli {

namespace {

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

PipelineRequest complete_request(const PipelineOptions& options) {
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
    return request;
}

/// Runs, and closes the log. That the log could not be written is an error of the run.
RunReport run_logged(const Pipeline& pipeline, RunSettings settings, Verbosity verbosity) {
    RunGuard guard(settings.folder, *settings.cancel, kCancelled);
    RunLog log(settings.folder, verbosity);
    settings.on_progress = [&](const RunProgress& progress) {
        guard.set_at_work(progress.at_work);
        if (const std::size_t width = log.status_width(); width > 0)
            log.status(progress_text(progress, width));
    };
    Checksums checksums(settings.cancel, settings.threads > 1);
    settings.checksums = &checksums;
    RunReport report = run_pipeline(pipeline, settings, log);
    guard.set_at_work({});
    log.status("checksums of the data");
    add_checksums(report, checksums, settings.cancel);
    log.status("");
    for (const std::string& error : report.errors) log.error(error);
    try {
        log.close();
    } catch (const Error& error) {
        report.status = RunStatus::failed;
        report.errors.emplace_back(error.what());
        std::cerr << "error: " << error.what() << "\n";
    }
    return report;
}

void write_run_json(const RunReport& report, const Pipeline& pipeline,
                    const std::filesystem::path& folder) {
    try {
        PendingFile file(folder / "run.json");
        write_file(file.path(), to_json(report, pipeline));
        file.commit();
    } catch (const Error& error) {
        note_end(folder, "failed", error.what());
        throw;
    }
}

}  // namespace

int run_pipeline_file(const PipelineOptions& options, const GlobalOptions& global) {
    // A limit on the size of files is an error of the write, like a full disk, not the end.
    std::signal(SIGXFSZ, SIG_IGN);
    end_on_interrupt();
    const PluginSet plugins = find_plugins(global);
    const PipelineRequest request = complete_request(options);
    int code = kDone;
    const auto pipeline = checked(request, plugins, code);
    if (!pipeline) return code;
    if (!debug_ids_known(options.debug, *pipeline)) return kWrongUsage;

    RunSettings settings;
    settings.threads = thread_count(options.threads);
    settings.debug.insert(options.debug.begin(), options.debug.end());
    settings.cancel = &catch_interrupts();  // a run folder has to be left in order
    settings.folder = prepare_run_folder(*request.out, options.force,
                                         RunInputs{request.data.value_or(""), request.file});
    settings.thread_limits = plugins.thread_limits;
    const std::filesystem::path folder = settings.folder;
    RunReport report;
    try {
        report = run_logged(*pipeline, std::move(settings), global.verbosity());
    } catch (const std::exception& failure) {
        note_end(folder, "failed", failure.what());
        throw;
    }
    write_run_json(report, *pipeline, folder);
    print_summary(report, folder);
    return exit_code(report);
}

void add_run(CLI::App& app, const GlobalOptions& global, Action& action) {
    auto options = std::make_shared<PipelineOptions>();
    CLI::App* command = app.add_subcommand("run", "run a pipeline into a run folder");
    options->add_to(*command);
    command->callback([options, &global, &action] {
        action = [options, &global] { return run_pipeline_file(*options, global); };
    });
}

}  // namespace petal::cli
