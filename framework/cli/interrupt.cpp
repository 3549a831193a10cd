// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "interrupt.hpp"

#include <unistd.h>

#include <csignal>

#include "command.hpp"

namespace petal::cli {

namespace {

std::atomic<bool> interrupted{false};
static_assert(std::atomic<bool>::is_always_lock_free, "written from a signal handler");

extern "C" void on_first_interrupt(int) {
    if (interrupted.exchange(true)) ::_exit(kCancelled);
}

extern "C" void on_any_interrupt(int) {
    ::_exit(kCancelled);
}

void handle_with(void (*handler)(int)) {
    std::signal(SIGINT, handler);
    std::signal(SIGTERM, handler);
}

}  // namespace

void end_on_interrupt() {
    handle_with(on_any_interrupt);
}

const std::atomic<bool>& catch_interrupts() {
    handle_with(on_first_interrupt);
    return interrupted;
}

}  // namespace petal::cli
