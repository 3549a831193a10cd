// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <vector>

#include "detectors/detail/lidar_template_rays.hpp"
#include "detectors/detail/lidar_template_shape.hpp"

namespace petal {

/// How bright it is behind each side of the plate: the mean logarithm of the energy of the rays
/// that miss the plate by less than about half a beam there, less the mean of all sides. What
/// differs by less than 0.15 is alike; what differs more counts from there. 0 for a side with too
/// few of them (sky), and where intensities tell nothing.
std::vector<double> backgrounds_of(const PlateShape& shape, const RayBundle& rays);

}  // namespace petal
