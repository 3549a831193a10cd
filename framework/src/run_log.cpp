// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "run_log.hpp"

#include <spdlog/pattern_formatter.h>
#include <spdlog/sinks/basic_file_sink.h>
#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>

#include <atomic>
#include <vector>

#include "petal/output.hpp"

namespace petal {

namespace {

spdlog::level::level_enum to_spdlog(LogLevel level) {
    switch (level) {
        case LogLevel::debug:
            return spdlog::level::debug;
        case LogLevel::info:
            return spdlog::level::info;
        case LogLevel::warning:
            return spdlog::level::warn;
    }
    return spdlog::level::info;
}

spdlog::level::level_enum terminal_level(Verbosity verbosity) {
    switch (verbosity) {
        case Verbosity::quiet:
            return spdlog::level::err;
        case Verbosity::normal:
            return spdlog::level::info;
        case Verbosity::verbose:
            return spdlog::level::debug;
    }
    return spdlog::level::info;
}

}  // namespace

struct RunLog::State {
    explicit State(const std::filesystem::path& folder) : file(folder / "log.txt") {}
    PendingFile file;
    std::unique_ptr<spdlog::logger> logger;
    std::atomic<bool> incomplete{false};
};

RunLog::RunLog(const std::filesystem::path& folder, Verbosity verbosity)
    : state_(std::make_unique<State>(folder)) {
    try {
        auto to_file =
            std::make_shared<spdlog::sinks::basic_file_sink_mt>(state_->file.path().string(), true);
        to_file->set_formatter(std::make_unique<spdlog::pattern_formatter>(
            "%Y-%m-%dT%H:%M:%S.%eZ %l %v", spdlog::pattern_time_type::utc));
        to_file->set_level(verbosity == Verbosity::verbose ? spdlog::level::debug
                                                           : spdlog::level::info);
        auto to_terminal = std::make_shared<spdlog::sinks::stderr_sink_mt>();
        to_terminal->set_pattern("%v");
        to_terminal->set_level(terminal_level(verbosity));
        state_->logger = std::make_unique<spdlog::logger>(
            "petal", spdlog::sinks_init_list{to_file, to_terminal});
        state_->logger->set_level(spdlog::level::debug);
        // spdlog itself only prints such failures and goes on.
        state_->logger->set_error_handler(
            [state = state_.get()](const std::string&) { state->incomplete = true; });
    } catch (const spdlog::spdlog_ex& failure) {
        throw Error(std::string("cannot write the log: ") + failure.what() +
                    "; give another folder with --out");
    }
}

RunLog::~RunLog() {
    try {
        close();
    } catch (const std::exception&) {
        // A destructor must not throw; whoever needs to know calls close().
    }
}

void RunLog::write(LogLevel level, const std::string& message) {
    if (state_->logger) state_->logger->log(to_spdlog(level), message);
}

void RunLog::error(const std::string& message) {
    if (state_->logger) state_->logger->log(spdlog::level::err, "error: " + message);
}

void RunLog::close() {
    if (!state_->logger) return;
    state_->logger->flush();
    state_->logger.reset();
    if (state_->incomplete)
        throw Error("cannot write " + state_->file.final_path().string() + "; is the disk full?");
    state_->file.commit();
}

}  // namespace petal
