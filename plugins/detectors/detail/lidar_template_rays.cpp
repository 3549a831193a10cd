// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "detectors/detail/lidar_template_rays.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>

#include "petal/calibration/plane_fit.hpp"

namespace petal {
namespace {

constexpr double kRaysLeastSine = 0.1;     ///< of a ray to the plane: 6 deg
constexpr double kRaysLeastSigma = 0.002;  ///< m: LiDARs resolve no less
constexpr double kMostSigma = 0.03;        ///< m
constexpr double kHitSigmas = 3.0;         ///< a ray within as many of the plane hit it ...
constexpr double kLeastHitSigmas = 1.5;    ///< ... or fewer, where something is close behind
constexpr double kNearestShare = 0.1;      ///< of the misses: the nearest surface behind
constexpr std::size_t kRaysLeastPoints = 30;
constexpr int kPlaneFits = 4;

}  // namespace

RayBundle gather_rays(const Cloud& cloud, const Eigen::Isometry3d& T_lidar_plane, double radius,
                      std::size_t most) {
    RayBundle bundle;
    bundle.radius = radius;
    bundle.T_lidar_plane = T_lidar_plane;
    const Eigen::Vector3d into = T_lidar_plane.linear().col(2);
    const Eigen::Vector3d origin = T_lidar_plane.translation();
    const double distance = into.dot(origin);
    const auto& xs = cloud.points->getPointsBufferRef_x();
    const auto& ys = cloud.points->getPointsBufferRef_y();
    const auto& zs = cloud.points->getPointsBufferRef_z();
    const double limit = radius * radius;
    std::vector<std::uint32_t> crossing;
    for (std::size_t i = 0; i < xs.size(); ++i) {
        const Eigen::Vector3d p(static_cast<double>(xs[i]), static_cast<double>(ys[i]),
                                static_cast<double>(zs[i]));
        const double deep = into.dot(p);
        if (!(deep > 0.0)) continue;
        const double scale = distance / deep;
        if (!((scale * p - origin).squaredNorm() <= limit)) continue;
        if (deep < kRaysLeastSine * p.norm()) continue;
        crossing.push_back(static_cast<std::uint32_t>(i));
    }
    bundle.crossed = crossing.size();
    const std::size_t stride = crossing.size() / std::max<std::size_t>(most, 1) + 1;
    bundle.rays.reserve(crossing.size() / stride + 1);
    for (std::size_t k = 0; k < crossing.size(); k += stride) {
        const std::size_t i = crossing[k];
        bundle.rays.push_back(
            {{static_cast<double>(xs[i]), static_cast<double>(ys[i]), static_cast<double>(zs[i])},
             {0.0, 0.0},
             0.0});
    }
    replace_plane(bundle, T_lidar_plane);
    return bundle;
}

void replace_plane(RayBundle& bundle, const Eigen::Isometry3d& T_lidar_plane) {
    bundle.T_lidar_plane = T_lidar_plane;
    const Eigen::Vector3d into = T_lidar_plane.linear().col(2);
    const double distance = into.dot(T_lidar_plane.translation());
    const Eigen::Isometry3d to_plane = T_lidar_plane.inverse();
    for (PlaneRay& ray : bundle.rays) {
        const double scale = distance / into.dot(ray.point);
        ray.place = (to_plane * (scale * ray.point)).head<2>();
        ray.beyond = (1.0 - scale) * ray.point.norm();
    }
}

void measure_ranges(RayBundle& bundle, const PlacesOfPlane& plate, const PlacesOfPlane& open) {
    std::vector<double> off, behind;
    for (const PlaneRay& ray : bundle.rays)
        if (std::abs(ray.beyond) <= 2.0 * kMostSigma && plate(ray.place))
            off.push_back(std::abs(ray.beyond));
    bundle.range_sigma = kMostSigma;
    if (!off.empty()) {
        const auto middle = off.begin() + static_cast<std::ptrdiff_t>(off.size() / 2);
        std::nth_element(off.begin(), middle, off.end());
        bundle.range_sigma = std::clamp(1.4826 * *middle, kRaysLeastSigma, kMostSigma);
    }
    bundle.hit_depth = kHitSigmas * bundle.range_sigma;
    for (const PlaneRay& ray : bundle.rays)
        if (ray.beyond > bundle.hit_depth && open(ray.place)) behind.push_back(ray.beyond);
    bundle.gap = 0.0;
    if (behind.size() < kRaysLeastPoints) return;
    const auto near = behind.begin() + static_cast<std::ptrdiff_t>(
                                           static_cast<double>(behind.size()) * kNearestShare);
    std::nth_element(behind.begin(), near, behind.end());
    bundle.gap = *near;
    bundle.hit_depth =
        std::clamp(0.5 * bundle.gap, kLeastHitSigmas * bundle.range_sigma, bundle.hit_depth);
}

bool fit_plane(RayBundle& bundle, double radius, double depth) {
    for (int step = 0; step < kPlaneFits; ++step) {
        PlaneFitter fitter;
        for (const PlaneRay& ray : bundle.rays)
            if (ray.place.squaredNorm() <= radius * radius && std::abs(ray.beyond) <= depth)
                fitter.add(ray.point);
        if (fitter.size() < kRaysLeastPoints) return false;
        const std::optional<PlaneFit> fit = fitter.fit();
        if (!fit) return false;
        const Eigen::Vector3d ray = bundle.T_lidar_plane.translation();
        const double reach = -fit->normal.dot(ray);
        if (!(reach > kRaysLeastSine * ray.norm())) return false;
        replace_plane(bundle, plane_frame(fit->normal, ray * (fit->offset / reach)));
        const auto near = [&](const Eigen::Vector2d& place) {
            return place.squaredNorm() <= radius * radius;
        };
        measure_ranges(bundle, near, near);
        depth = bundle.hit_depth;
    }
    return true;
}

}  // namespace petal
