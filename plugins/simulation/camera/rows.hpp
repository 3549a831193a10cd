// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include "petal/run.hpp"

namespace petal::simulation {

/// Calls work(row) for rows 0 to `rows` - 1, on the run's threads. What a row gives must not depend
/// on another row of the same call. \throws Cancelled; whatever `work` throws.
template <class Work>
void for_rows(const Run& run, int rows, const Work& work) {
    tbb::task_arena(run.threads()).execute([&] {
        tbb::parallel_for(0, rows, [&](int row) {
            if (!run.cancelled()) work(row);
        });
    });
    run.check_cancelled();
}

}  // namespace petal::simulation
