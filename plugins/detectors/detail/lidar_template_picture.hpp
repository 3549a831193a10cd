// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <filesystem>

#include "detectors/detail/lidar_template_attempt.hpp"

namespace petal {

/// Draws what one attempt saw: where rays that hit cross the plane (black) and where those do that
/// missed (light), and the target's edges where it was fitted, green for a board, red for the
/// nearest miss. The board is 500 px wide. \throws Error where the file cannot be written.
void draw_plate(const PlateTemplate& target, const PlateAttempt& attempt,
                const std::filesystem::path& file);

}  // namespace petal
