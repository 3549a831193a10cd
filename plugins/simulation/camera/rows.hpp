// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <cstddef>

#include "petal/calibration/for_pieces.hpp"
#include "petal/run.hpp"

namespace petal::simulation {

/// Calls work(row) for rows 0 to `rows` - 1, on the run's threads. What a row gives must not depend
/// on another row of the same call. \throws Cancelled; whatever `work` throws.
template <class Work>
void for_rows(const Run& run, int rows, const Work& work) {
    for_pieces(run, static_cast<std::size_t>(rows), 1, [&](std::size_t row, std::size_t end) {
        for (; row < end; ++row) work(static_cast<int>(row));
    });
}

}  // namespace petal::simulation
