// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <cstddef>
#include <mutex>
#include <string>
#include <string_view>

namespace petal {

/// Standard error as a run uses it: lines that stay, and below them one that is drawn over, which
/// only a terminal gets. The two never mix. Thread-safe.
class ProgressTerminal {
   public:
    /// Without `with_status` not one control character is written.
    explicit ProgressTerminal(bool with_status) : with_status_(with_status) {}
    ProgressTerminal(const ProgressTerminal&) = delete;
    ProgressTerminal& operator=(const ProgressTerminal&) = delete;
    ~ProgressTerminal() { set_status(""); }

    /// Lines that stay; `lines` ends in a line feed.
    void print(std::string_view lines);
    /// The line that is drawn over; empty removes it.
    void set_status(const std::string& status);
    /// Columns that a status may have; 0 where there is none.
    std::size_t width() const;

   private:
    std::mutex mutex_;
    bool with_status_;
    std::string status_;
};

/// True where standard error is a terminal that a line can be drawn over on.
bool stderr_takes_status();

}  // namespace petal
