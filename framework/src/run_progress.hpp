// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace petal {

/// How far a source said it is. `total` is 0 where it does not know, or said nothing.
struct SourceProgress {
    double done = 0.0;
    double total = 0.0;
    std::string unit;  ///< "files"; "B" for bytes
};

/// How far a run is, at one moment.
struct RunProgress {
    std::vector<std::string> at_work;  ///< ids of the stages that fire, in topological order
    std::uint64_t frames_emitted = 0;  ///< by the source
    std::uint64_t frames_done = 0;     ///< have passed all stages that fire frame by frame
    double elapsed_s = 0.0;
    SourceProgress source;
};

/// One line for a terminal, of at most `width` columns and without control characters: the stages
/// at work, frames done, their rate, how far the source is, the remaining time. What does not fit
/// is left out from the right; names are shortened first. Empty where `width` is too small for
/// anything. Stage ids are ASCII, so a column is a byte.
std::string progress_text(const RunProgress& progress, std::size_t width);

/// "8 s", "3 min 20 s", "2 h 5 min".
std::string duration_text(double seconds);

/// The remaining time in seconds, from the share of the data that has passed all stages; negative
/// where it cannot be told.
double remaining_s(const RunProgress& progress);

}  // namespace petal
