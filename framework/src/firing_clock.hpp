// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <chrono>
#include <cstddef>
#include <vector>

namespace petal {

inline double seconds_since(std::chrono::steady_clock::time_point start) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// Seconds of CPU time that the calling thread has used.
double thread_cpu_seconds();

/// Wall and CPU time of the firings of one thread, by stage. Reading a thread's CPU clock is a
/// system call that costs more than a small firing, so it is read once for all firings of some
/// 100 us; these share the CPU time by their wall time.
class FiringClock {
   public:
    explicit FiringClock(std::size_t stages) : times_(stages), open_(stages, 0.0) {}

    struct Times {
        double wall_s = 0.0;
        double cpu_s = 0.0;
    };

    /// A firing of that stage ended on this thread just now.
    void add(std::size_t stage, double wall_s);
    /// All that was added since the clock was made.
    const std::vector<Times>& times();

   private:
    void settle();

    std::vector<Times> times_;
    std::vector<double> open_;  ///< wall time whose CPU time is not known yet
    double open_sum_ = 0.0;
    double cpu_read_ = thread_cpu_seconds();
};

}  // namespace petal
