// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <Eigen/Core>
#include <vector>

#include "detectors/detail/image_edge_sampler.hpp"
#include "detectors/detail/image_layout.hpp"
#include "detectors/detail/image_template_model.hpp"
#include "petal/calibration/camera_model.hpp"

namespace petal {

/// What tells, at the price of some fifty grey values, which of many thousand guesses are worth a
/// closer look: whether the plate is of one brightness and the holes are darker where an affine map
/// puts them.
class PlaceLook {
   public:
    PlaceLook(const EdgeSampler& edges, const TemplateModel& model, const CameraModel& camera,
              double noise);

    /// 0 to 1: the share of the plate that is even, times that of the holes that is darker. `map`
    /// goes from the board (m) to ideal pixels. 0 where half of the plate is out of the image.
    double at(const Homography& map) const;

   private:
    std::vector<double> greys_at(const Homography& map,
                                 const std::vector<Eigen::Vector2d>& points) const;

    const EdgeSampler& edges_;
    const CameraModel& camera_;
    double noise_;
    std::vector<Eigen::Vector2d> plate_, holes_;  ///< m, the board's frame
};

}  // namespace petal
