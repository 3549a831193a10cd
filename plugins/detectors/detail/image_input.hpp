// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <opencv2/core.hpp>

#include "petal/calibration/camera_model.hpp"
#include "petal/calibration/images.hpp"

namespace petal {

/// The pixels of a camera's image, shared with it. \throws Error naming the camera when there are
/// none, when they are not 8 bit with 1 or 3 channels, or not of the size that the intrinsics are
/// for.
cv::Mat pixels_of(const CameraImage& camera);

/// \throws Error naming the camera when its intrinsics are none.
CameraModel model_of(const CameraImage& camera);

}  // namespace petal
