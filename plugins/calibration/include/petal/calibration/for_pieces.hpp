// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <cstddef>

#include "petal/run.hpp"

namespace petal {

/// Calls `work`, whose tasks run on the run's threads. In the runner's own arena they run there:
/// the thread that waits for stages then takes part, which could not enter an arena within it, so
/// that with two threads one would be left (or none, where the stage is with the other one).
template <class Work>
void on_run_threads(const Run& run, const Work& work) {
    if (tbb::this_task_arena::max_concurrency() == run.threads())
        work();
    else
        tbb::task_arena(run.threads()).execute(work);
}

/// Calls work(begin, end) for pieces of 0 to `count` of about `piece` indices, on the run's
/// threads. What one index gives must not depend on another. \throws Cancelled; whatever `work`
/// throws.
template <class Work>
void for_pieces(const Run& run, std::size_t count, std::size_t piece, const Work& work) {
    on_run_threads(run, [&] {
        tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count, piece), [&](const auto& part) {
            if (!run.cancelled()) work(part.begin(), part.end());
        });
    });
    run.check_cancelled();
}

}  // namespace petal
