// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "petal/calibration/cloud.hpp"
#include "petal/calibration/plane_fit.hpp"
#include "petal/run.hpp"

namespace petal {

struct PlaneSearchParams {
    double plane_threshold = 0.05;
    double patch_radius = 0.5;
    int min_inliers = 40;
    double confidence = 0.9999;
    int max_iterations = 500;
};

/// A plane patch and its points: indices into the cloud, ascending.
struct PlanePatch {
    PlaneFit fit;
    std::vector<std::uint32_t> inliers;
    int iterations = 0;
};

/// RANSAC for one plane patch at a time (equations (2)(3), lines 6 to 12 of Algorithm 1). Refers to
/// the cloud's own coordinates: the cloud must outlive it.
class PlaneSearch {
   public:
    PlaneSearch(const mrpt::maps::CPointsMap& points, const PlaneSearchParams& params);

    /// The best patch among the points `remaining` (indices), none with fewer than min_inliers
    /// points. A hypothesis costs one pass over the points. `poll` is called before each seed
    /// point.
    std::optional<PlanePatch> best(const std::vector<std::uint32_t>& remaining, Rng& rng,
                                   const std::function<void()>& poll);

    /// The most points that any hypothesis of the last search had.
    std::size_t most_inliers() const { return most_inliers_; }

   private:
    Eigen::Vector3d at(std::uint32_t i) const;
    void collect_near(const std::vector<std::uint32_t>& from, const Eigen::Vector3d& centre);
    std::optional<PlanePatch> refit(const std::vector<std::uint32_t>& remaining,
                                    const PlaneFit& start);

    const mrpt::aligned_std_vector<float>& x_;
    const mrpt::aligned_std_vector<float>& y_;
    const mrpt::aligned_std_vector<float>& z_;
    PlaneSearchParams params_;
    std::vector<std::uint32_t> near_;  ///< scratch: indices within patch_radius of the seed
    std::size_t most_inliers_ = 0;
};

}  // namespace petal
