// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <functional>
#include <opencv2/core.hpp>

namespace petal {

/// Binary versions of an 8 bit grey image, without a hand-set threshold: `levels` global thresholds
/// at quantiles of its grey values, so that no grey level is special, and local means at three
/// scales less the image's own noise. `visit` gets each in a fixed order: 255 where bright; it may
/// change what it is given, and throw to end the sweep.
void visit_binaries(const cv::Mat& grey, int levels,
                    const std::function<void(const cv::Mat&)>& visit);

/// More of them, for what differs from its surroundings by a few grey levels: the image is smoothed
/// at two scales in floating point, and a pixel counts as dark (in every second image: as bright)
/// where it differs from the local mean by 2.5 sigma of what noise the smoothing left.
void visit_faint_binaries(const cv::Mat& grey, const std::function<void(const cv::Mat&)>& visit);

/// Grey levels, 1 sigma: the image's noise, by the median difference of neighbours; at least what
/// rounding to whole levels makes.
double image_noise(const cv::Mat& grey);

}  // namespace petal
