// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "run_log.hpp"

#include <spdlog/pattern_formatter.h>
#include <spdlog/sinks/base_sink.h>
#include <spdlog/sinks/basic_file_sink.h>
#include <spdlog/spdlog.h>

#include <atomic>
#include <vector>

#include "petal/output.hpp"
#include "progress_terminal.hpp"

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

/// The messages of spdlog on the terminal that the progress is drawn on.
class TerminalSink final : public spdlog::sinks::base_sink<spdlog::details::null_mutex> {
   public:
    explicit TerminalSink(ProgressTerminal& terminal) : terminal_(terminal) {}

   private:
    void sink_it_(const spdlog::details::log_msg& message) override {
        terminal_.print(fmt::to_string(message.payload) + "\n");
    }
    void flush_() override {}

    ProgressTerminal& terminal_;
};

}  // namespace

struct RunLog::State {
    State(const std::filesystem::path& folder, bool with_status)
        : file(folder / "log.txt"), terminal(with_status) {}
    PendingFile file;
    ProgressTerminal terminal;
    std::unique_ptr<spdlog::logger> logger;
    std::atomic<bool> incomplete{false};
};

RunLog::RunLog(const std::filesystem::path& folder, Verbosity verbosity)
    : state_(
          std::make_unique<State>(folder, verbosity != Verbosity::quiet && stderr_takes_status())) {
    try {
        auto to_file =
            std::make_shared<spdlog::sinks::basic_file_sink_mt>(state_->file.path().string(), true);
        to_file->set_formatter(std::make_unique<spdlog::pattern_formatter>(
            "%Y-%m-%dT%H:%M:%S.%eZ %l %v", spdlog::pattern_time_type::utc));
        to_file->set_level(verbosity == Verbosity::verbose ? spdlog::level::debug
                                                           : spdlog::level::info);
        auto to_terminal = std::make_shared<TerminalSink>(state_->terminal);
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

void RunLog::status(const std::string& text) {
    state_->terminal.set_status(text);
}

std::size_t RunLog::status_width() const {
    return state_->terminal.width();
}

void RunLog::close() {
    state_->terminal.set_status("");
    if (!state_->logger) return;
    state_->logger->flush();
    state_->logger.reset();
    if (state_->incomplete)
        throw Error("cannot write " + state_->file.final_path().string() +
                    "; is the disk full? Free some space, or give another folder with --out");
    state_->file.commit();
}

}  // namespace petal
