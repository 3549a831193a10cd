// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <cstddef>
#include <vector>

#include "filters/detail/angular_cells.hpp"

namespace petal {

/// What a cell tells its neighbours.
struct CellRanges {
    float nearest = 0.0F;   ///< m
    float farthest = 0.0F;  ///< m
    float inverse = 0.0F;   ///< 1/m: of the range where its nearest points crowd, at:
    float azimuth = 0.0F, elevation = 0.0F;  ///< rad, the mean of its points
};

/// \param threshold m; points with less depth are on one surface
/// \param noise of ranges, m, 1 sigma
/// \param scratch anything
CellRanges cell_ranges(const AngularCells& cells, std::size_t cell, float threshold, float noise,
                       std::vector<float>& scratch);

}  // namespace petal
