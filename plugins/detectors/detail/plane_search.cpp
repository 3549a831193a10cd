// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "detectors/detail/plane_search.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace petal {
namespace {

constexpr int kPairsPerSeed = 8;  ///< hypotheses that share a seed point and its neighbourhood
constexpr int kMinSeeds = 30;     ///< before the adaptive end may apply
constexpr int kRefits = 4;

std::size_t pick(Rng& rng, std::size_t count) {
    return static_cast<std::size_t>(rng() % count);
}

/// Seeds needed to meet at least one good triple with the given confidence.
double seeds_needed(double on_plane, double neighbours_on_plane, double confidence) {
    const double pair = neighbours_on_plane * neighbours_on_plane;
    const double seed = on_plane * (1.0 - std::pow(1.0 - pair, kPairsPerSeed));
    if (seed <= 0.0) return 1e18;
    if (seed >= 1.0) return 1.0;
    return std::log(1.0 - confidence) / std::log1p(-seed);
}

}  // namespace

PlaneSearch::PlaneSearch(const mrpt::maps::CPointsMap& points, const PlaneSearchParams& params)
    : x_(points.getPointsBufferRef_x()),
      y_(points.getPointsBufferRef_y()),
      z_(points.getPointsBufferRef_z()),
      params_(params) {}

Eigen::Vector3d PlaneSearch::at(std::uint32_t i) const {
    return {static_cast<double>(x_[i]), static_cast<double>(y_[i]), static_cast<double>(z_[i])};
}

void PlaneSearch::collect_near(const std::vector<std::uint32_t>& from,
                               const Eigen::Vector3d& centre) {
    const double limit = params_.patch_radius * params_.patch_radius;
    near_.clear();
    for (const std::uint32_t i : from)
        if ((at(i) - centre).squaredNorm() <= limit) near_.push_back(i);
}

std::optional<PlanePatch> PlaneSearch::best(const std::vector<std::uint32_t>& remaining, Rng& rng,
                                            const std::function<void()>& poll) {
    most_inliers_ = 0;
    const std::size_t min_inliers = static_cast<std::size_t>(params_.min_inliers);
    if (remaining.size() < min_inliers) return std::nullopt;

    double best_score = 0.0;
    PlaneFit best_fit;
    int seeds = 0;
    double needed = 1e18;
    while (seeds < params_.max_iterations && (seeds < kMinSeeds || seeds < needed)) {
        poll();
        ++seeds;
        const Eigen::Vector3d a = at(remaining[pick(rng, remaining.size())]);
        collect_near(remaining, a);
        if (near_.size() < min_inliers) {
            most_inliers_ = std::max(most_inliers_, near_.size());
            continue;
        }
        for (int pair = 0; pair < kPairsPerSeed; ++pair) {
            const Eigen::Vector3d b = at(near_[pick(rng, near_.size())]);
            const Eigen::Vector3d c = at(near_[pick(rng, near_.size())]);
            const Eigen::Vector3d cross = (b - a).cross(c - a);
            // Twice the area: below a tenth of the patch's, three points with errors of about the
            // threshold say nothing of the normal.
            if (cross.norm() < 0.1 * params_.patch_radius * params_.patch_radius) continue;
            PlaneFit plane;
            plane.normal = cross.normalized();
            plane.offset = -plane.normal.dot(a);
            plane.centroid = a;
            double score = 0.0;
            std::size_t count = 0;
            for (const std::uint32_t i : near_) {
                const double relative = plane.distance(at(i)) / params_.plane_threshold;
                if (std::abs(relative) >= 1.0) continue;
                ++count;
                score += 1.0 - relative * relative;
            }
            most_inliers_ = std::max(most_inliers_, count);
            if (score <= best_score) continue;
            best_score = score;
            best_fit = plane;
            const double inliers = static_cast<double>(count);
            needed = seeds_needed(inliers / static_cast<double>(remaining.size()),
                                  inliers / static_cast<double>(near_.size()), params_.confidence);
        }
    }
    if (best_score <= 0.0) return std::nullopt;
    std::optional<PlanePatch> patch = refit(remaining, best_fit);
    if (!patch || patch->inliers.size() < min_inliers) return std::nullopt;
    patch->iterations = seeds;
    return patch;
}

std::optional<PlanePatch> PlaneSearch::refit(const std::vector<std::uint32_t>& remaining,
                                             const PlaneFit& start) {
    PlanePatch patch;
    patch.fit = start;
    for (int round = 0; round < kRefits; ++round) {
        collect_near(remaining, patch.fit.centroid);
        PlaneFitter fitter;
        patch.inliers.clear();
        for (const std::uint32_t i : near_) {
            const Eigen::Vector3d p = at(i);
            if (std::abs(patch.fit.distance(p)) >= params_.plane_threshold) continue;
            fitter.add(p);
            patch.inliers.push_back(i);
        }
        const std::optional<PlaneFit> fit = fitter.fit();
        if (!fit) return std::nullopt;
        patch.fit = *fit;
    }
    return patch;
}

}  // namespace petal
