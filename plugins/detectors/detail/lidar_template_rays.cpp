// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "detectors/detail/lidar_template_rays.hpp"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>

#include "petal/calibration/angles.hpp"
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
constexpr std::size_t kLookAtShare = 3;  ///< of the points in such directions, one in three crosses
constexpr double kLeastIntensity = 1e-3;  ///< of 1
constexpr std::size_t kLookAhead = 16;
constexpr std::size_t kRaysPiece = 8192;
constexpr std::size_t kMeasuredRays = 30000;  ///< of more, some tell noise and gap

/// The points in directions that may cross a circle about a place.
struct NearRays {
    Eigen::Vector3d axis;
    double angle = 0.0;  ///< rad

    NearRays(const Eigen::Vector3d& middle, double radius) {
        const double range = middle.norm();
        axis = middle / range;
        // The sphere around the middle holds the circle.
        angle = radius < range ? std::asin(radius / range) : kPi;
    }
    std::size_t count(const CloudDirections& directions) const {
        std::size_t sum = 0;
        directions.around(axis, angle, [&](const auto* begin, const auto* end) {
            sum += static_cast<std::size_t>(end - begin);
        });
        return sum;
    }
};

/// Indices of points in neighbouring directions.
struct Stretch {
    const std::uint32_t* begin;
    const std::uint32_t* end;
};

/// Every `stride`-th of the points near, all stretches together counted through.
std::vector<Stretch> stretches_of(const CloudDirections& directions, const NearRays& near,
                                  std::size_t stride) {
    std::vector<Stretch> stretches;
    std::size_t skip = 0;
    directions.around(
        near.axis, near.angle, [&](const std::uint32_t* begin, const std::uint32_t* end) {
            const auto size = static_cast<std::size_t>(end - begin);
            if (skip < size) stretches.push_back({begin + skip, end});
            // The first of the next stretch.
            skip = skip < size ? (stride - (size - skip) % stride) % stride : skip - size;
        });
    return stretches;
}

/// Indices of the points p whose rays cross the plane n.x = h within the radius of its origin o:
///     |h / (n.p) p - o|^2 <= radius^2, multiplied by (n.p)^2;
/// of every `stride`-th point there.
std::vector<std::uint32_t> crossing_rays(const CloudDirections& directions, const NearRays& near,
                                         std::size_t stride, const Eigen::Isometry3d& T_lidar_plane,
                                         double radius) {
    const mrpt::maps::CPointsMapXYZI& points = *directions.cloud().points;
    const Eigen::Vector3f n = T_lidar_plane.linear().col(2).cast<float>();
    const Eigen::Vector3f o = T_lidar_plane.translation().cast<float>();
    const float h = n.dot(o), rest = o.squaredNorm() - static_cast<float>(radius * radius);
    const float least = static_cast<float>(kRaysLeastSine * kRaysLeastSine);
    const float* xs = points.getPointsBufferRef_x().data();
    const float* ys = points.getPointsBufferRef_y().data();
    const float* zs = points.getPointsBufferRef_z().data();
    const std::vector<Stretch> stretches = stretches_of(directions, near, stride);
    std::vector<std::vector<std::uint32_t>> found(stretches.size());
    tbb::parallel_for(std::size_t{0}, stretches.size(), [&](std::size_t k) {
        const auto size = static_cast<std::size_t>(stretches[k].end - stretches[k].begin);
        const std::uint32_t* indices = stretches[k].begin;
        for (std::size_t j = 0; j < size; j += stride) {
            // Neighbours in direction lie far apart in the cloud.
            if (const std::size_t later = j + kLookAhead * stride; later < size) {
                __builtin_prefetch(xs + indices[later]);
                __builtin_prefetch(ys + indices[later]);
                __builtin_prefetch(zs + indices[later]);
            }
            const std::uint32_t i = indices[j];
            const float x = xs[i], y = ys[i], z = zs[i];
            const float deep = n.x() * x + n.y() * y + n.z() * z;
            const float square = x * x + y * y + z * z;
            const float along = o.x() * x + o.y() * y + o.z() * z;
            const float off = h * (h * square - 2.0F * deep * along) + rest * deep * deep;
            if (deep > 0.0F && off <= 0.0F && deep * deep >= least * square) found[k].push_back(i);
        }
    });
    std::vector<std::uint32_t> all;
    for (const auto& some : found) all.insert(all.end(), some.begin(), some.end());
    return all;
}

/// Calls visit(ray, index) for each, on the threads of the calling task.
template <class Visit>
void each_ray(RayBundle& bundle, const Visit& visit) {
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, bundle.rays.size(), kRaysPiece),
                      [&](const auto& piece) {
                          for (std::size_t k = piece.begin(); k < piece.end(); ++k)
                              visit(bundle.rays[k], k);
                      });
}

}  // namespace

RayBundle gather_rays(const CloudDirections& directions, const Eigen::Isometry3d& T_lidar_plane,
                      double radius, std::size_t most) {
    const Cloud& cloud = directions.cloud();
    RayBundle bundle;
    bundle.radius = radius;
    bundle.T_lidar_plane = T_lidar_plane;
    // Of many rays only as many are looked at as hold `most`, were a third of them to cross.
    const NearRays near(T_lidar_plane.translation(), radius);
    most = std::max<std::size_t>(most, 1);
    const std::size_t look = near.count(directions) / kLookAtShare / most + 1;
    const std::vector<std::uint32_t> crossing =
        crossing_rays(directions, near, look, T_lidar_plane, radius);
    const auto& xs = cloud.points->getPointsBufferRef_x();
    const auto& ys = cloud.points->getPointsBufferRef_y();
    const auto& zs = cloud.points->getPointsBufferRef_z();
    const auto& intensities = cloud.points->getPointsBufferRef_intensity();
    bundle.crossed = look * crossing.size();
    const std::size_t stride = crossing.size() / most + 1;
    bundle.rays.resize((crossing.size() + stride - 1) / stride);
    each_ray(bundle, [&](PlaneRay& ray, std::size_t k) {
        const std::size_t i = crossing[k * stride];
        ray.point = {static_cast<double>(xs[i]), static_cast<double>(ys[i]),
                     static_cast<double>(zs[i])};
        // What is no number comes second in std::max, so that it loses.
        ray.log_energy = std::log(std::max(kLeastIntensity, static_cast<double>(intensities[i])) /
                                  ray.point.squaredNorm());
    });
    replace_plane(bundle, T_lidar_plane);
    return bundle;
}

void replace_plane(RayBundle& bundle, const Eigen::Isometry3d& T_lidar_plane) {
    bundle.T_lidar_plane = T_lidar_plane;
    const Eigen::Vector3d into = T_lidar_plane.linear().col(2);
    const double distance = into.dot(T_lidar_plane.translation());
    const Eigen::Isometry3d to_plane = T_lidar_plane.inverse();
    each_ray(bundle, [&](PlaneRay& ray, std::size_t) {
        const double scale = distance / into.dot(ray.point);
        ray.place = (to_plane * (scale * ray.point)).head<2>();
        ray.beyond = (1.0 - scale) * ray.point.norm();
    });
}

void measure_ranges(RayBundle& bundle, const PlacesOfPlane& plate, const PlacesOfPlane& open) {
    std::vector<double> off, behind;
    const std::size_t stride = bundle.rays.size() / kMeasuredRays + 1;
    for (std::size_t k = 0; k < bundle.rays.size(); k += stride) {
        const PlaneRay& ray = bundle.rays[k];
        if (std::abs(ray.beyond) <= 2.0 * kMostSigma && plate(ray.place))
            off.push_back(std::abs(ray.beyond));
    }
    bundle.range_sigma = kMostSigma;
    if (!off.empty()) {
        const auto middle = off.begin() + static_cast<std::ptrdiff_t>(off.size() / 2);
        std::nth_element(off.begin(), middle, off.end());
        bundle.range_sigma = std::clamp(1.4826 * *middle, kRaysLeastSigma, kMostSigma);
    }
    bundle.hit_depth = kHitSigmas * bundle.range_sigma;
    for (std::size_t k = 0; k < bundle.rays.size(); k += stride) {
        const PlaneRay& ray = bundle.rays[k];
        if (ray.beyond > bundle.hit_depth && open(ray.place)) behind.push_back(ray.beyond);
    }
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
