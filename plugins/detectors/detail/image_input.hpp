// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <functional>
#include <opencv2/core.hpp>
#include <string>

#include "petal/calibration/boards.hpp"
#include "petal/calibration/camera_model.hpp"
#include "petal/calibration/images.hpp"
#include "petal/run.hpp"

namespace petal {

/// The pixels of a camera's image, shared with it. \throws Error naming the camera when there are
/// none, when they are not 8 bit with 1 or 3 channels, or not of the size that the intrinsics are
/// for.
cv::Mat pixels_of(const CameraImage& camera);

/// The same in one channel; shared where it has no more.
cv::Mat grey_of(const cv::Mat& pixels);

/// \throws Error naming the camera when its intrinsics are none.
CameraModel model_of(const CameraImage& camera);

/// What every image_board_detector does: `detect` adds the boards of each image on `images`, and
/// all are written to `boards`. A target given as a file is told as used; a scene without an image
/// gets a note.
void write_image_boards(Run& run, const std::string& target,
                        const std::function<void(const CameraImage&, ImageBoards&)>& detect);

}  // namespace petal
