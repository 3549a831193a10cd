// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "metrics/detail/seen_boards.hpp"
#include "petal/calibration/target.hpp"

namespace petal {

/// The sides of a target's polygonal holes, as indices in Target::corners().
std::vector<std::pair<int, int>> hole_sides(const Target& target);

/// How far the edges of a board in the coloured cloud lie from the real ones, m: an edge that the
/// camera sees is displayed where the rays through its ends meet the board's plane. One number a
/// side: the larger distance of its displayed ends from the line of the real one (no point between
/// them is farther). A target without polygonal holes has no sides: then of each corner its own
/// distance. None where fewer than three corners are finite, or a ray does not meet the plane.
std::optional<std::vector<double>> displayed_distances(
    const SeenBoard& board, const std::vector<std::pair<int, int>>& sides);

}  // namespace petal
