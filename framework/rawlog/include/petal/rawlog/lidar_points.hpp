// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <mrpt/maps/CPointsMapXYZI.h>
#include <mrpt/obs/CObservation.h>

namespace petal {

/// Whether append_lidar_points knows the class: CObservationPointCloud, CObservation3DRangeScan,
/// CObservationVelodyneScan, CObservationRotatingScan, CObservation2DRangeScan.
bool is_lidar(const mrpt::obs::CObservation& observation);

/// Whether the observation's points have an intensity that append_lidar_points reads.
bool has_intensity(const mrpt::obs::CObservation& observation);

/// Appends the observation's points in the sensor's own frame (its pose on the vehicle is not
/// applied) with intensity where there is one (0 else). Works on `observation` where MRPT
/// converts in place.
/// \throws Error naming the sensor where the class cannot be converted.
void append_lidar_points(mrpt::obs::CObservation& observation, mrpt::maps::CPointsMapXYZI& points);

}  // namespace petal
