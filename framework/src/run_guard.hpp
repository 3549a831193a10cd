// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <atomic>
#include <chrono>
#include <filesystem>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "ticker.hpp"

namespace petal {

/// Sees to it that a cancelled run ends soon. Stages are asked to stop; where one does not within
/// 0.6 s, because it does not poll or is inside some library, the guard leaves the folder as a
/// cancelled run does (run.json says so and names the stage, no temporary file is left) and ends
/// the program.
class RunGuard {
   public:
    /// `folder` is the run's; `exit_code` that of the program.
    RunGuard(std::filesystem::path folder, const std::atomic<bool>& cancel, int exit_code);

    /// The stages that fire at the moment, for the message.
    void set_at_work(std::vector<std::string> stages);

   private:
    void tick();
    [[noreturn]] void end_program();

    const std::filesystem::path folder_;
    const std::atomic<bool>& cancel_;
    const int exit_code_;
    std::mutex mutex_;
    std::vector<std::string> at_work_;
    std::optional<std::chrono::steady_clock::time_point> asked_;
    Ticker ticker_;  // last: it uses the rest
};

}  // namespace petal
