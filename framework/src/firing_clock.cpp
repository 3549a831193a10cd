// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "firing_clock.hpp"

#include <time.h>

#include <algorithm>

namespace petal {

namespace {

constexpr double kReadEvery = 100e-6;  // s of firings

}  // namespace

double thread_cpu_seconds() {
    timespec now{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

void FiringClock::add(std::size_t stage, double wall_s) {
    times_[stage].wall_s += wall_s;
    open_[stage] += wall_s;
    open_sum_ += wall_s;
    if (open_sum_ >= kReadEvery) settle();
}

const std::vector<FiringClock::Times>& FiringClock::times() {
    settle();
    return times_;
}

void FiringClock::settle() {
    const double now = thread_cpu_seconds();
    // What is more than the firings took is the runner's own.
    const double used = std::min(now - cpu_read_, open_sum_);
    cpu_read_ = now;
    if (open_sum_ <= 0.0) return;
    for (std::size_t i = 0; i < open_.size(); ++i) {
        times_[i].cpu_s += used * open_[i] / open_sum_;
        open_[i] = 0.0;
    }
    open_sum_ = 0.0;
}

}  // namespace petal
