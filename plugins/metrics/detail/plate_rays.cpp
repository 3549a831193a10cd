// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "metrics/detail/plate_rays.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "petal/calibration/for_pieces.hpp"

namespace petal {
namespace {

constexpr std::size_t kFewestPlanePoints = 30;
constexpr std::size_t kPointsAtOnce = 65536;

/// A point of the plate: where, from its middle, and how far off.
struct PlatePoint {
    Eigen::Vector2d from;
    double off;
};

/// Points of the plate, with their weights 0 or 1 by the distance from the plane so far.
PlatePlane fit_once(const std::vector<PlatePoint>& points, const PlatePlane& before, double limit) {
    Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
    Eigen::Vector3d right = Eigen::Vector3d::Zero();
    double squares = 0.0;
    PlatePlane plane;
    for (const PlatePoint& point : points) {
        if (std::abs(point.off - before.at(point.from)) > limit) continue;
        const Eigen::Vector3d row(1.0, point.from.x(), point.from.y());
        normal += row * row.transpose();
        right += row * point.off;
        squares += point.off * point.off;
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

/// Tells points that are surely outside a cone from the others, many at once: in single precision,
/// with room for its rounding. Most points of a capture lie outside.
class ConeGlance {
   public:
    static constexpr std::size_t kPoints = 1024;

    ConeGlance(const Eigen::Vector3f& axis, float cosine)
        : axis_(axis), least_(0.9999F * cosine * cosine - 1e-5F) {}

    void look(const float* xs, const float* ys, const float* zs, std::size_t count) {
        using Floats = Eigen::Map<const Eigen::ArrayXf>;
        const auto size = static_cast<Eigen::Index>(count);
        const Floats x(xs, size), y(ys, size), z(zs, size);
        along_.head(size) = axis_.x() * x + axis_.y() * y + axis_.z() * z;
        inside_.head(size) =
            along_.head(size) * along_.head(size).abs() - least_ * (x * x + y * y + z * z);
    }
    /// Written so that what is no number may be in.
    bool may_be_in(std::size_t point) const {
        return !(inside_[static_cast<Eigen::Index>(point)] < 0.0F);
    }

   private:
    Eigen::Vector3f axis_;
    float least_;
    Eigen::Array<float, static_cast<int>(kPoints), 1> along_, inside_;
};

}  // namespace

std::vector<PlateRay> plate_rays(const Run& run, const Cloud& cloud,
                                 const Eigen::Isometry3d& T_lidar_board, double width,
                                 double height, double border) {
    std::vector<PlateRay> rays;
    const Eigen::Isometry3d to_board = T_lidar_board.inverse();
    if (!to_board.matrix().allFinite()) return rays;
    const Eigen::Vector3d sensor = to_board.translation();
    const Eigen::Vector3d middle = T_lidar_board * Eigen::Vector3d(0.5 * width, 0.5 * height, 0.0);
    const double radius = 0.5 * std::hypot(width, height) + 2.0 * border;
    const double range = middle.norm();
    if (sensor.z() > -1e-3 || range <= radius) return rays;
    // A cone around the board drops what lies elsewhere.
    const Eigen::Vector3d axis = middle / range;
    const double cosine = std::sqrt(1.0 - (radius / range) * (radius / range));
    const auto& xs = cloud.points->getPointsBufferRef_x();
    const auto& ys = cloud.points->getPointsBufferRef_y();
    const auto& zs = cloud.points->getPointsBufferRef_z();
    const auto add = [&](std::size_t i, std::vector<PlateRay>& to) {
        const Eigen::Vector3d p(static_cast<double>(xs[i]), static_cast<double>(ys[i]),
                                static_cast<double>(zs[i]));
        const double along = axis.dot(p);
        if (!(along > 0.0) || !(along * along >= cosine * cosine * p.squaredNorm())) return;
        const Eigen::Vector3d ray = to_board * p - sensor;
        if (!(ray.z() > 1e-6) || !ray.allFinite()) return;
        const double share = -sensor.z() / ray.z();
        PlateRay found;
        found.lean = ray.head<2>() / ray.z();
        found.at = sensor.head<2>() - sensor.z() * found.lean;
        if (found.at.x() < -border || found.at.x() > width + border || found.at.y() < -border ||
            found.at.y() > height + border)
            return;
        found.depth = (1.0 - share) * ray.norm();
        found.off = sensor.z() + ray.z();
        found.point = i;
        to.push_back(found);
    };
    std::vector<std::vector<PlateRay>> parts((xs.size() + kPointsAtOnce - 1) / kPointsAtOnce);
    for_pieces(run, parts.size(), 1, [&](std::size_t part, std::size_t end) {
        ConeGlance glance(axis.cast<float>(), static_cast<float>(cosine));
        for (; part < end; ++part) {
            const std::size_t last = std::min((part + 1) * kPointsAtOnce, xs.size());
            for (std::size_t i = part * kPointsAtOnce; i < last; i += ConeGlance::kPoints) {
                const std::size_t count = std::min(ConeGlance::kPoints, last - i);
                glance.look(&xs[i], &ys[i], &zs[i], count);
                for (std::size_t k = 0; k < count; ++k)
                    if (glance.may_be_in(k)) add(i + k, parts[part]);
            }
        }
    });
    for (const auto& part : parts) rays.insert(rays.end(), part.begin(), part.end());
    return rays;
}

std::optional<PlatePlane> plate_plane(const std::vector<PlateRay>& rays, const PlateEdges& edges,
                                      double from_edge, double depth) {
    std::vector<PlatePoint> points;
    std::vector<double> offs;
    for (const PlateRay& ray : rays) {
        if (std::abs(ray.off) > depth || edges.inside(ray.at) < from_edge) continue;
        points.push_back({ray.at - edges.middle(), ray.off});
        offs.push_back(ray.off);
    }
    if (points.size() < kFewestPlanePoints) return std::nullopt;
    PlatePlane plane;
    // The median first, so that a wall close behind does not draw the plane to itself.
    const auto half = offs.begin() + static_cast<std::ptrdiff_t>(offs.size() / 2);
    std::nth_element(offs.begin(), half, offs.end());
    plane.value.x() = *half;
    double limit = depth;
    for (int turn = 0; turn < 4; ++turn) {
        plane = fit_once(points, plane, limit);
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
