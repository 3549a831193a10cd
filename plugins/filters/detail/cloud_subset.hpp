// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "petal/calibration/cloud.hpp"
#include "petal/run.hpp"

namespace petal {

/// Whether all coordinates of point `i` are finite.
bool is_finite(const Cloud& cloud, std::size_t i);

/// Indices of the points whose coordinates are all finite, ascending.
std::vector<std::uint32_t> finite_points(const Cloud& cloud);

/// The points with these indices into `cloud`, ascending, with their intensity; label and pose as
/// they are, `parts` empty. Each keeps its index in the scene's own cloud: that of
/// `cloud.scene_index`, or its index in `cloud` where that is empty.
Cloud subset(const Cloud& cloud, const std::vector<std::uint32_t>& indices);

/// What every remover of outliers tells and writes: the points with `indices` (ascending) go out on
/// `cloud`; how many stay is logged. Notes tell of an empty cloud, of points that were dropped as
/// they are not finite, and, with the text of `none_stays`, where no point stays of `finite` ones.
void write_subset(Run& run, const Cloud& cloud, const std::vector<std::uint32_t>& indices,
                  std::size_t finite, const Note& none_stays);

}  // namespace petal
