// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "progress_terminal.hpp"

#include <sys/ioctl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>

namespace petal {

namespace {

constexpr char kClearLine[] = "\r\x1b[K";

/// All of it in one piece where the terminal takes it. What it does not take is lost: there is
/// nobody left to tell.
void write_stderr(std::string_view text) {
    while (!text.empty()) {
        const ssize_t written = ::write(STDERR_FILENO, text.data(), text.size());
        if (written < 0 && errno == EINTR) continue;
        if (written <= 0) return;
        text.remove_prefix(static_cast<std::size_t>(written));
    }
}

}  // namespace

void ProgressTerminal::print(std::string_view lines) {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (status_.empty()) return write_stderr(lines);
    std::string text = kClearLine;
    text += lines;
    text += status_;
    write_stderr(text);
}

void ProgressTerminal::set_status(const std::string& status) {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (!with_status_ || status == status_) return;
    write_stderr(kClearLine + status);
    status_ = status;
}

std::size_t ProgressTerminal::width() const {
    if (!with_status_) return 0;
    winsize size{};
    // The last column stays free: some terminals go to the next line when it is written.
    if (::ioctl(STDERR_FILENO, TIOCGWINSZ, &size) != 0 || size.ws_col == 0) return 79;
    return static_cast<std::size_t>(size.ws_col) - 1;
}

bool stderr_takes_status() {
    const char* terminal = std::getenv("TERM");
    return ::isatty(STDERR_FILENO) == 1 &&
           (terminal == nullptr || std::string_view(terminal) != "dumb");
}

}  // namespace petal
