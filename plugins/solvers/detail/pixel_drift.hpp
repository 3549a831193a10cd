// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <string>
#include <vector>

#include "petal/calibration/camera_model.hpp"
#include "petal/calibration/diagnosis.hpp"
#include "petal/calibration/se3.hpp"

namespace petal {

/// The largest 1 sigma of a pixel straight ahead at 5, 20 and 50 m, by the pose's covariance and by
/// the one with doubt in the intrinsics (both of a left perturbation of T_camera_lidar).
std::vector<Diagnosis::Drift> pixel_drifts(const CameraModel& model, const Matrix6d& covariance,
                                           const Matrix6d& considered);

/// "; straight ahead at 5, 20 and 50 m that is ... px": ends a sentence on the weakest direction.
std::string drift_text(const std::vector<Diagnosis::Drift>& drifts);

}  // namespace petal
