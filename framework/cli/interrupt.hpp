// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <atomic>

namespace petal::cli {

/// From now on SIGINT and SIGTERM end the program at once, with the exit code kCancelled.
void end_on_interrupt();

/// From now on the first SIGINT or SIGTERM sets the flag; a second one ends the program at once,
/// with the exit code kCancelled.
const std::atomic<bool>& catch_interrupts();

}  // namespace petal::cli
