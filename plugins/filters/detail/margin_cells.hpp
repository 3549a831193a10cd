// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "filters/detail/angular_cells.hpp"
#include "petal/run.hpp"

namespace petal {

struct MarginSettings {
    float noise = 0.012F;       ///< of ranges, m, 1 sigma
    float threshold = 0.072F;   ///< delta_range, m
    float deflation = 1.0F;     ///< standard deviations
    int reach = 1;              ///< cells to each side that are looked at; 0 or 1
    int min_points = 5;         ///< of a frontier
    float edge_reach = 0.005F;  ///< rad: so near a margin point something lies behind; with reach 1
};

/// How many cells were seen as what.
struct MarginCounts {
    std::size_t cells = 0;
    std::size_t margin = 0;  ///< with a frontier and something behind it
};

/// Marks the margin points (1) by their index in the map: Algorithm 1 of the letter, lines 1 to 5.
/// See docs/margin_points.md.
MarginCounts mark_margin_points(const AngularCells& cells, const MarginSettings& settings,
                                const Run& run, std::vector<std::uint8_t>& marks);

}  // namespace petal
