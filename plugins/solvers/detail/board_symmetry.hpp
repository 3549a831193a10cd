// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <Eigen/Core>
#include <vector>

#include "petal/calibration/boards.hpp"

namespace petal {

/// permutation[i] is the LiDAR corner that lies where corner i lies before the rotation.
using CornerOrder = std::vector<std::size_t>;

/// The rotations in its plane that map a board's corners onto themselves, to within 0.45 of
/// their mean distance to the nearest other corner; the identity first, then by angle. Four for the
/// square board. No mirror images: both sensors see the front.
std::vector<CornerOrder> board_rotations(const std::vector<Eigen::Vector3d>& corners);

}  // namespace petal
