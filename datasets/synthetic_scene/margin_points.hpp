// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "scene.hpp"

namespace petal::synthetic {

/// Edge points as the letter's margin-point filter would keep them: along hole and board sides,
/// about 10 mm on the board's side of them as in the real indoor data, 3 mm noise across and 6 mm
/// in range, and some clutter. LiDAR frame, m.
std::vector<Eigen::Vector3d> margin_points(const Scene& scene, std::uint64_t seed);

}  // namespace petal::synthetic
