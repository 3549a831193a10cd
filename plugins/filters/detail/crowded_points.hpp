// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "petal/calibration/cloud.hpp"
#include "petal/run.hpp"

namespace petal {

/// Of the points with these indices (ascending, of finite coordinates) those that have at least
/// `enough` others of them nearer than `distance` (m), in their order. In time linear in the
/// points: a cell of distance / sqrt(3) lies within the ball of each of its points, so those of a
/// full cell stay without a look at any distance.
std::vector<std::uint32_t> crowded_points(const Cloud& cloud,
                                          const std::vector<std::uint32_t>& indices,
                                          double distance, std::size_t enough, const Run& run);

/// What removers of lonely points do with their `cloud`: crowded_points() of those that are finite
/// go out. `threshold` and `hint` are for the note where none stays.
void write_crowded_points(Run& run, double distance, int enough, const std::string& threshold,
                          const std::string& hint);

}  // namespace petal
