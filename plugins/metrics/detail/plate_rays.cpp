// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "metrics/detail/plate_rays.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace petal {
namespace {

constexpr std::size_t kFewestPlanePoints = 30;

/// Points of the plate, with their weights 0 or 1 by the distance from the plane so far.
PlatePlane fit_once(const std::vector<PlateRay>& rays, const std::vector<std::size_t>& members,
                    const Eigen::Vector2d& middle, const PlatePlane& before, double limit) {
    Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
    Eigen::Vector3d right = Eigen::Vector3d::Zero();
    double squares = 0.0;
    PlatePlane plane;
    for (const std::size_t i : members) {
        const Eigen::Vector2d from = rays[i].at - middle;
        if (std::abs(rays[i].off - before.at(from)) > limit) continue;
        const Eigen::Vector3d row(1.0, from.x(), from.y());
        normal += row * row.transpose();
        right += row * rays[i].off;
        squares += rays[i].off * rays[i].off;
        ++plane.count;
    }
    if (plane.count < kFewestPlanePoints) return plane;
    const Eigen::FullPivLU<Eigen::Matrix3d> lu(normal);
    if (!lu.isInvertible()) {
        plane.count = 0;
        return plane;
    }
    plane.value = lu.solve(right);
    const double left = std::max(0.0, squares - plane.value.dot(right));
    const double variance = left / static_cast<double>(plane.count - 3);
    plane.rms = std::sqrt(variance);
    plane.covariance = variance * lu.inverse();
    return plane;
}

}  // namespace

std::vector<PlateRay> plate_rays(const Cloud& cloud, const Eigen::Isometry3d& T_lidar_board,
                                 double width, double height, double border) {
    std::vector<PlateRay> rays;
    const Eigen::Isometry3d to_board = T_lidar_board.inverse();
    if (!to_board.matrix().allFinite()) return rays;
    const Eigen::Vector3d sensor = to_board.translation();
    const Eigen::Vector3d middle = T_lidar_board * Eigen::Vector3d(0.5 * width, 0.5 * height, 0.0);
    const double radius = 0.5 * std::hypot(width, height) + 2.0 * border;
    const double range = middle.norm();
    if (sensor.z() > -1e-3 || range <= radius) return rays;
    // Most points of a capture lie elsewhere: a cone around the board drops them at once.
    const Eigen::Vector3d axis = middle / range;
    const double cosine = std::sqrt(1.0 - (radius / range) * (radius / range));
    const auto& xs = cloud.points->getPointsBufferRef_x();
    const auto& ys = cloud.points->getPointsBufferRef_y();
    const auto& zs = cloud.points->getPointsBufferRef_z();
    for (std::size_t i = 0; i < xs.size(); ++i) {
        const Eigen::Vector3d p(static_cast<double>(xs[i]), static_cast<double>(ys[i]),
                                static_cast<double>(zs[i]));
        const double along = axis.dot(p);
        if (!(along > 0.0) || !(along * along >= cosine * cosine * p.squaredNorm())) continue;
        const Eigen::Vector3d ray = to_board * p - sensor;
        if (!(ray.z() > 1e-6) || !ray.allFinite()) continue;
        const double share = -sensor.z() / ray.z();
        PlateRay found;
        found.lean = ray.head<2>() / ray.z();
        found.at = sensor.head<2>() - sensor.z() * found.lean;
        if (found.at.x() < -border || found.at.x() > width + border || found.at.y() < -border ||
            found.at.y() > height + border)
            continue;
        found.depth = (1.0 - share) * ray.norm();
        found.off = sensor.z() + ray.z();
        found.point = i;
        rays.push_back(found);
    }
    return rays;
}

std::optional<PlatePlane> plate_plane(const std::vector<PlateRay>& rays, const PlateEdges& edges,
                                      double from_edge, double depth) {
    std::vector<std::size_t> members;
    for (std::size_t i = 0; i < rays.size(); ++i)
        if (std::abs(rays[i].off) <= depth && edges.inside(rays[i].at) >= from_edge)
            members.push_back(i);
    if (members.size() < kFewestPlanePoints) return std::nullopt;
    PlatePlane plane;
    // The median first, so that a wall close behind does not draw the plane to itself.
    std::vector<double> offs;
    offs.reserve(members.size());
    for (const std::size_t i : members) offs.push_back(rays[i].off);
    const auto half = offs.begin() + static_cast<std::ptrdiff_t>(offs.size() / 2);
    std::nth_element(offs.begin(), half, offs.end());
    plane.value.x() = *half;
    double limit = depth;
    for (int turn = 0; turn < 4; ++turn) {
        plane = fit_once(rays, members, edges.middle(), plane, limit);
        if (plane.count < kFewestPlanePoints) return std::nullopt;
        limit = std::max(3.5 * plane.rms, 1e-4);
    }
    return plane;
}

void flatten(std::vector<PlateRay>& rays, const PlatePlane& plane, const Eigen::Vector2d& middle) {
    for (PlateRay& ray : rays) {
        // Where the ray meets the plane itself: at + lean t with t = value at that place.
        const double slope = plane.value.tail<2>().dot(ray.lean);
        const double t = plane.at(ray.at - middle) / (1.0 - slope);
        const double stretch = std::sqrt(1.0 + ray.lean.squaredNorm());
        ray.at += t * ray.lean;
        ray.depth -= t * stretch;
        ray.off = ray.depth / stretch * (1.0 - slope);
    }
}

}  // namespace petal
