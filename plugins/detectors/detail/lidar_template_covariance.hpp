// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <Eigen/Core>

#include "detectors/detail/lidar_template_likelihood.hpp"
#include "detectors/detail/lidar_template_plane.hpp"
#include "detectors/detail/lidar_template_shape.hpp"

namespace petal {

/// m, 1 sigma, across the beam's level and its upright axis: the error that the rays of a side
/// share, by how the sides of an evaluation with scores scatter. A beam is thin one way and tall
/// the other, and what stands behind a side moves it by the beam's size.
Eigen::Vector2d common_of(const PlateShape& shape, const PlateEvaluation& at);

/// Of all parameters at the maximum: sides weigh as their common error allows, the plane by the
/// plate's own points. `stretches`: whether the stretch was free.
PlateMatrix plate_covariance(const PlateEvaluation& at, const PlaneOfPlate& plane,
                             const Eigen::Vector2d& common, bool stretches);

}  // namespace petal
