// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "detectors/detail/lidar_template_patches.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <tuple>

#include "detectors/detail/plane_search.hpp"

namespace petal {
namespace {

constexpr double kPatchRadius = 1.4;  ///< of the board's: 0.5 m for one of 0.5 m
constexpr int kMostPatches = 30;

std::vector<Eigen::Vector3d> finite_points(const mrpt::maps::CPointsMap& cloud) {
    std::vector<Eigen::Vector3d> points;
    for (std::size_t i = 0; i < cloud.size(); ++i) {
        float x, y, z;
        cloud.getPoint(i, x, y, z);
        if (std::isfinite(x) && std::isfinite(y) && std::isfinite(z))
            points.emplace_back(static_cast<double>(x), static_cast<double>(y),
                                static_cast<double>(z));
    }
    return points;
}

}  // namespace

std::optional<Eigen::Vector3d> centre_of(const Plane& plane) {
    const auto points = finite_points(*plane.inliers.points);
    if (points.empty()) return std::nullopt;
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (const Eigen::Vector3d& p : points) sum += p;
    return sum / static_cast<double>(points.size());
}

EdgePatches::EdgePatches(const Cloud& cloud, const Planes* planes, const PlateShape& shape,
                         Rng& rng, const std::function<void()>& poll)
    : points_(finite_points(*cloud.points)) {
    const auto less = [](const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
        return std::make_tuple(a.x(), a.y(), a.z()) < std::make_tuple(b.x(), b.y(), b.z());
    };
    std::sort(points_.begin(), points_.end(), less);
    points_.erase(std::unique(points_.begin(), points_.end()), points_.end());
    if (planes != nullptr) {
        for (const Plane& plane : planes->planes)
            if (const auto centre = centre_of(plane)) {
                PlateCandidate patch;
                patch.centre = *centre;
                patch.normal = plane.normal;
                patches_.push_back(patch);
            }
        return;
    }
    mrpt::maps::CPointsMapXYZI map;
    map.reserve(points_.size());
    for (const Eigen::Vector3d& p : points_)
        map.insertPointFast(static_cast<float>(p.x()), static_cast<float>(p.y()),
                            static_cast<float>(p.z()));
    PlaneSearchParams params;
    params.patch_radius = kPatchRadius * shape.radius();
    PlaneSearch search(map, params);
    std::vector<std::uint32_t> remaining(points_.size());
    for (std::size_t i = 0; i < remaining.size(); ++i) remaining[i] = static_cast<std::uint32_t>(i);
    while (patches_.size() < kMostPatches) {
        const auto found = search.best(remaining, rng, poll);
        if (!found) break;
        PlateCandidate patch;
        patch.centre = found->fit.centroid;
        patch.normal = found->fit.normal;
        patches_.push_back(patch);
        std::vector<std::uint32_t> rest;
        std::set_difference(remaining.begin(), remaining.end(), found->inliers.begin(),
                            found->inliers.end(), std::back_inserter(rest));
        remaining = std::move(rest);
    }
}

}  // namespace petal
