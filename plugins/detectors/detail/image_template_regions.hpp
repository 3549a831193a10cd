// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <Eigen/Core>
#include <functional>
#include <opencv2/core.hpp>
#include <vector>

#include "detectors/detail/image_template_model.hpp"

namespace petal {

/// A dark region that may be a hole, or a bright one that may be a plate. Raw pixels.
struct ImageRegion {
    TemplateShape shape;                ///< px, px^2
    int votes = 1;                      ///< binary images in which it was seen
    std::vector<Eigen::Vector2d> hull;  ///< of the first of them
};

struct RegionSearch {
    std::vector<ImageRegion> holes;   ///< by row, then by column; each once
    std::vector<ImageRegion> plates;  ///< the same
    int borders = 0;                  ///< looked at, over all binary images
};

/// Regions whose moments are those of one of the model's holes, or of its outline, up to an affine
/// map, in global and local binary images of an 8 bit grey image. `check` is called between them
/// and may throw.
RegionSearch find_regions(const cv::Mat& grey, const TemplateModel& model, int levels,
                          const std::function<void()>& check);

}  // namespace petal
