// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "run_guard.hpp"

#include <unistd.h>

#include <utility>

#include "run_folder.hpp"

namespace petal {

namespace {

using std::chrono::steady_clock;

constexpr std::chrono::milliseconds kLook{50};
constexpr std::chrono::milliseconds kPatience{600};

}  // namespace

RunGuard::RunGuard(std::filesystem::path folder, const std::atomic<bool>& cancel, int exit_code)
    : folder_(std::move(folder)),
      cancel_(cancel),
      exit_code_(exit_code),
      ticker_(kLook, [this] { tick(); }) {}

void RunGuard::set_at_work(std::vector<std::string> stages) {
    const std::lock_guard<std::mutex> lock(mutex_);
    at_work_ = std::move(stages);
}

void RunGuard::tick() {
    if (!cancel_.load()) return;
    if (!asked_) asked_ = steady_clock::now();
    if (steady_clock::now() - *asked_ >= kPatience) end_program();
}

void RunGuard::end_program() {
    std::string stages;
    {
        const std::lock_guard<std::mutex> lock(mutex_);
        for (const std::string& stage : at_work_) stages += (stages.empty() ? "" : ", ") + stage;
    }
    const std::string what = std::string("cancelled") +
                             (stages.empty() ? "" : " while at work in " + stages) +
                             "; what was at work did not stop by itself, so the program was ended";
    remove_temporaries(folder_);
    note_end(folder_, "cancelled", what);
    // No stream of the program: a thread that does not stop may hold its lock.
    const std::string line = "\npetal: " + what + "\n";
    static_cast<void>(!::write(STDERR_FILENO, line.data(), line.size()));
    ::_exit(exit_code_);  // not exit(): it would destroy what stages still use
}

}  // namespace petal
