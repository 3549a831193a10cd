// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <filesystem>

#include "detectors/detail/board_line_finder.hpp"

namespace petal {

/// Draws what one search saw, in plane coordinates as the sensor sees them: points black, lines
/// grey, corners as crosses, green for a board, red for the nearest miss. 1 px is 1 mm of the
/// plane. \throws Error where the file cannot be written.
void draw_attempt(const BoardAttempt& attempt, const std::filesystem::path& file);

}  // namespace petal
