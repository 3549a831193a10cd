// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <sys/types.h>

#include <cstddef>
#include <functional>
#include <map>
#include <optional>
#include <string>

namespace petal::compare {

/// How a child process ended.
struct ChildEnd {
    std::size_t job = 0;
    int exit_code = 0;  ///< where no signal ended it
    int signal = 0;
};
/// "signal 11 (Segmentation fault)", "ended the program with exit code 1".
std::string to_string(const ChildEnd& end);

/// Jobs in processes of their own, forked off this one with all that it has loaded: a stage that
/// crashes, or ends the program, takes its own job along and nothing else. They end with this
/// process, whatever ends it. \pre this process has one thread.
class ChildPool {
   public:
    /// `work` runs in the child; its result is the exit code.
    explicit ChildPool(std::function<int(std::size_t job)> work) : work_(std::move(work)) {}
    ChildPool(const ChildPool&) = delete;
    ChildPool& operator=(const ChildPool&) = delete;
    /// Ends the children that are still at work.
    ~ChildPool();

    /// \throws Error where no process can be made.
    void start(std::size_t job);
    std::size_t running() const { return jobs_.size(); }
    /// A child that has ended meanwhile; waits for one for at most `seconds`.
    std::optional<ChildEnd> wait(double seconds);

   private:
    std::function<int(std::size_t)> work_;
    std::map<pid_t, std::size_t> jobs_;
};

}  // namespace petal::compare
