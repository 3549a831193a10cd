// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "detectors/detail/lidar_template_rays.hpp"

#include <algorithm>
#include <array>
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
constexpr std::size_t kRaysPiece = 4096;

/// Indices of the points p whose rays cross the plane n.x = h within the radius of its origin o:
///     |h / (n.p) p - o|^2 <= radius^2, multiplied by (n.p)^2.
/// Pass by pass over pieces that stay in the cache, so that the compiler can take several points at
/// once: every plate goes over the whole cloud.
std::vector<std::uint32_t> crossing_rays(const mrpt::maps::CPointsMapXYZI& points,
                                         const Eigen::Isometry3d& T_lidar_plane, double radius) {
    const Eigen::Vector3f n = T_lidar_plane.linear().col(2).cast<float>();
    const Eigen::Vector3f o = T_lidar_plane.translation().cast<float>();
    const float h = n.dot(o), rest = o.squaredNorm() - static_cast<float>(radius * radius);
    const float least = static_cast<float>(kRaysLeastSine * kRaysLeastSine);
    const float* xs = points.getPointsBufferRef_x().data();
    const float* ys = points.getPointsBufferRef_y().data();
    const float* zs = points.getPointsBufferRef_z().data();
    const std::size_t count = points.size();
    std::vector<std::uint32_t> found;
    std::array<std::uint8_t, kRaysPiece> crosses{};
    for (std::size_t begin = 0; begin < count; begin += kRaysPiece) {
        const std::size_t size = std::min(kRaysPiece, count - begin);
        for (std::size_t k = 0; k < size; ++k) {
            const float x = xs[begin + k], y = ys[begin + k], z = zs[begin + k];
            const float deep = n.x() * x + n.y() * y + n.z() * z;
            const float square = x * x + y * y + z * z;
            const float along = o.x() * x + o.y() * y + o.z() * z;
            const float off = h * (h * square - 2.0F * deep * along) + rest * deep * deep;
            crosses[k] = static_cast<std::uint8_t>(static_cast<int>(deep > 0.0F) &
                                                   static_cast<int>(off <= 0.0F) &
                                                   static_cast<int>(deep * deep >= least * square));
        }
        for (std::size_t k = 0; k < size; ++k)
            if (crosses[k] != 0) found.push_back(static_cast<std::uint32_t>(begin + k));
    }
    return found;
}

}  // namespace

RayBundle gather_rays(const Cloud& cloud, const Eigen::Isometry3d& T_lidar_plane, double radius,
                      std::size_t most) {
    RayBundle bundle;
    bundle.radius = radius;
    bundle.T_lidar_plane = T_lidar_plane;
    const std::vector<std::uint32_t> crossing = crossing_rays(*cloud.points, T_lidar_plane, radius);
    const auto& xs = cloud.points->getPointsBufferRef_x();
    const auto& ys = cloud.points->getPointsBufferRef_y();
    const auto& zs = cloud.points->getPointsBufferRef_z();
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
