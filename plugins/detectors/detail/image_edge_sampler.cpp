// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "detectors/detail/image_edge_sampler.hpp"

#include <algorithm>
#include <cmath>

namespace petal {

namespace {

constexpr double kStep = 0.25;   ///< px between samples of a profile
constexpr double kSigma = 1.0;   ///< px, of the Gaussian: about the blur of an ordinary photo
constexpr int kHalfKernel = 12;  ///< samples: 3 sigma

}  // namespace

EdgeSampler::EdgeSampler(const cv::Mat& grey) : grey_(grey) {
    // Scaled so that a step of height 1 answers 1 at its place.
    double rise = 0.0;
    for (int k = -kHalfKernel; k <= kHalfKernel; ++k) {
        const double x = k * kStep / kSigma;
        kernel_.push_back(x * std::exp(-0.5 * x * x));
        if (k > 0) rise += kernel_.back();
    }
    for (double& weight : kernel_) weight /= rise;
}

std::optional<double> EdgeSampler::grey(const Eigen::Vector2d& p) const {
    if (!(p.x() >= 0.0 && p.y() >= 0.0 && p.x() <= grey_.cols - 1 && p.y() <= grey_.rows - 1))
        return std::nullopt;
    const int x = std::min(static_cast<int>(p.x()), grey_.cols - 2);
    const int y = std::min(static_cast<int>(p.y()), grey_.rows - 2);
    const double fx = p.x() - x, fy = p.y() - y;
    const std::uint8_t* upper = grey_.ptr<std::uint8_t>(y) + x;
    const std::uint8_t* lower = grey_.ptr<std::uint8_t>(y + 1) + x;
    return (1.0 - fy) * ((1.0 - fx) * upper[0] + fx * upper[1]) +
           fy * ((1.0 - fx) * lower[0] + fx * lower[1]);
}

std::optional<EdgePoint> EdgeSampler::steepest_rise(const Eigen::Vector2d& start,
                                                    const Eigen::Vector2d& direction,
                                                    double reach) const {
    const int half = std::max(2, static_cast<int>(std::ceil(reach / kStep)));
    const int samples = half + kHalfKernel;
    std::vector<double> profile;
    profile.reserve(2 * static_cast<std::size_t>(samples) + 1);
    for (int k = -samples; k <= samples; ++k) {
        const auto value = grey(start + k * kStep * direction);
        if (!value) return std::nullopt;
        profile.push_back(*value);
    }
    std::vector<double> rise(static_cast<std::size_t>(2 * half + 1), 0.0);
    std::size_t best = 0;
    for (std::size_t i = 0; i < rise.size(); ++i) {
        for (std::size_t k = 0; k < kernel_.size(); ++k) rise[i] += kernel_[k] * profile[i + k];
        if (rise[i] > rise[best]) best = i;
    }
    if (best == 0 || best + 1 == rise.size() || rise[best] <= 0.0) return std::nullopt;
    const double before = rise[best - 1], after = rise[best + 1];
    const double bend = before - 2.0 * rise[best] + after;
    const double shift = bend < 0.0 ? 0.5 * (before - after) / bend : 0.0;
    EdgePoint edge;
    edge.offset = (static_cast<double>(best) - half + shift) * kStep;
    edge.strength = rise[best];
    return edge;
}

}  // namespace petal
