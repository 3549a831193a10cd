// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <opencv2/core.hpp>

namespace petal {

/// The variance of the Laplacian, in squared grey levels: larger for a sharper image of the same
/// view. 8 bit, 1 or 3 channels.
double sharpness(const cv::Mat& image);

}  // namespace petal
