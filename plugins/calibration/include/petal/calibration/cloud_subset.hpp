// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "petal/calibration/cloud.hpp"

namespace petal {

/// Whether all coordinates of point `i` are finite.
bool is_finite(const Cloud& cloud, std::size_t i);

/// Indices of the points whose coordinates are all finite, ascending.
std::vector<std::uint32_t> finite_points(const Cloud& cloud);

/// The points with these indices into `cloud`, ascending, with their intensity; label and pose as
/// they are, `parts` empty. Each keeps its index in the scene's own cloud: that of
/// `cloud.scene_index`, or its index in `cloud` where that is empty.
Cloud subset(const Cloud& cloud, const std::vector<std::uint32_t>& indices);

}  // namespace petal
