// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "runner.hpp"

#include <sys/resource.h>
#include <tbb/global_control.h>
#include <time.h>

#include <chrono>
#include <optional>

#include "firing_clock.hpp"
#include "run_recorder.hpp"
#include "scheduler.hpp"
#include "ticker.hpp"

namespace petal {

namespace {

constexpr std::chrono::milliseconds kTellEvery{200};

double process_cpu_seconds() {
    timespec now{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

}  // namespace

RunReport run_pipeline(const Pipeline& pipeline, const RunSettings& settings, RunLog& log) {
    const auto start = std::chrono::steady_clock::now();
    const double cpu_start = process_cpu_seconds();
    // Caps whatever uses oneTBB inside a stage too.
    const tbb::global_control cap(tbb::global_control::max_allowed_parallelism,
                                  static_cast<std::size_t>(settings.threads));
    // After the cap: a pool told first would warn about it.
    for (const auto& limit : settings.thread_limits) limit(settings.threads);
    RunRecorder recorder(settings, pipeline.seed, log);
    RunReport report;
    report.threads = settings.threads;
    {
        Scheduler scheduler(pipeline, settings, recorder);
        std::optional<Ticker> ticker;
        if (settings.on_progress)
            ticker.emplace(kTellEvery, [&] {
                RunProgress progress = scheduler.progress();
                progress.elapsed_s = seconds_since(start);
                settings.on_progress(progress);
            });
        scheduler.run();
        ticker.reset();
        scheduler.fill(report);
    }
    recorder.fill(report, pipeline);
    report.wall_s = seconds_since(start);
    report.cpu_s = process_cpu_seconds() - cpu_start;
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    report.peak_memory_bytes = static_cast<std::uint64_t>(usage.ru_maxrss) * 1024;
    return report;
}

}  // namespace petal
