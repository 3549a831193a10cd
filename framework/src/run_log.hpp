// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <string>

#include "petal/run.hpp"

namespace petal {

/// How much reaches the terminal. log.txt always gets everything but debug lines (with `verbose`
/// those too).
enum class Verbosity { quiet, normal, verbose };

/// The log of one run: log.txt in the run folder, and the terminal's standard error. Thread-safe.
/// log.txt gets its name when close() is called, or when the log is destroyed. On a terminal,
/// unless quiet, there is a line below the messages that is drawn over: the progress.
class RunLog {
   public:
    RunLog(const std::filesystem::path& folder, Verbosity verbosity);
    RunLog(const RunLog&) = delete;
    RunLog& operator=(const RunLog&) = delete;
    ~RunLog();

    void write(LogLevel level, const std::string& message);
    /// Why the run failed: to the terminal too, however quiet.
    void error(const std::string& message);
    /// The line that is drawn over; empty removes it, and so does close().
    void status(const std::string& text);
    /// Columns that a status may have; 0 where nobody would see it.
    std::size_t status_width() const;
    /// \throws Error when the disk did not take it all.
    void close();

   private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace petal
