// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulation/world/surfaces.hpp"

#include <cmath>

#include "petal/calibration/polygon.hpp"

namespace petal::simulation {
namespace {

constexpr double kNearest = 1e-6;  // m: a ray that starts on a surface does not meet it

/// Whether a polygon is its own bounding box.
bool is_box(const PlanarSurface::Polygon& polygon, const Eigen::AlignedBox2d& box) {
    if (polygon.size() != 4) return false;
    for (std::size_t i = 0; i < 4; ++i) {
        const Eigen::Vector2d& p = polygon[i];
        const Eigen::Vector2d& next = polygon[(i + 1) % 4];
        const bool at_corner = (p.x() == box.min().x() || p.x() == box.max().x()) &&
                               (p.y() == box.min().y() || p.y() == box.max().y());
        if (!at_corner || (p.x() != next.x()) == (p.y() != next.y())) return false;
    }
    return true;
}

}  // namespace

PlanarSurface::PlanarSurface(const Eigen::Isometry3d& T_world_surface, Shape shape,
                             std::shared_ptr<const Texture> texture, Kind kind)
    : Surface(std::move(texture), kind),
      shape_(std::move(shape)),
      origin_(T_world_surface.translation()),
      x_(T_world_surface.linear().col(0)),
      y_(T_world_surface.linear().col(1)),
      normal_(T_world_surface.linear().col(2)) {
    for (const Eigen::Vector2d& p : shape_.outline) {
        outline_box_.extend(p);
        bounds_.extend(Eigen::Vector3d(origin_ + p.x() * x_ + p.y() * y_));
    }
    is_rectangle_ = is_box(shape_.outline, outline_box_);
}

PlanarSurface::Shape PlanarSurface::rectangle(double width, double height) {
    return {{{0.0, 0.0}, {width, 0.0}, {width, height}, {0.0, height}}, {}, {}};
}

bool PlanarSurface::covers(const Eigen::Vector2d& p) const {
    if (!outline_box_.contains(p)) return false;
    if (!is_rectangle_ && !inside_polygon(shape_.outline, p)) return false;
    for (const Circle& hole : shape_.round_holes)
        if ((p - hole.centre).squaredNorm() < hole.radius * hole.radius) return false;
    for (const Polygon& hole : shape_.holes)
        if (inside_polygon(hole, p)) return false;
    return true;
}

bool PlanarSurface::cast(const Ray& ray, Hit& hit) const {
    const double approach = normal_.dot(ray.direction);
    if (approach == 0.0) return false;
    const double range = normal_.dot(origin_ - ray.origin) / approach;
    if (!(range > kNearest && range < hit.range)) return false;
    const Eigen::Vector3d offset = ray.origin + range * ray.direction - origin_;
    const Eigen::Vector2d place(x_.dot(offset), y_.dot(offset));
    if (!covers(place)) return false;
    hit.range = range;
    hit.surface = this;
    hit.place = place;
    hit.normal = approach < 0.0 ? normal_ : Eigen::Vector3d(-normal_);
    return true;
}

CylinderSurface::CylinderSurface(const Eigen::Isometry3d& T_world_surface, double radius,
                                 double height, std::shared_ptr<const Texture> texture, Kind kind)
    : Surface(std::move(texture), kind),
      T_world_surface_(T_world_surface),
      T_surface_world_(T_world_surface.inverse()),
      radius_(radius),
      height_(height) {
    for (const double x : {-radius, radius})
        for (const double y : {-radius, radius})
            for (const double z : {0.0, height})
                bounds_.extend(Eigen::Vector3d(T_world_surface * Eigen::Vector3d(x, y, z)));
}

bool CylinderSurface::cast(const Ray& ray, Hit& hit) const {
    const Eigen::Vector3d origin = T_surface_world_ * ray.origin;
    const Eigen::Vector3d direction = T_surface_world_.linear() * ray.direction;
    const double a = direction.head<2>().squaredNorm();
    const double b = origin.head<2>().dot(direction.head<2>());
    const double c = origin.head<2>().squaredNorm() - radius_ * radius_;
    const double square = b * b - a * c;
    if (!(a > 0.0) || !(square > 0.0)) return false;
    const double root = std::sqrt(square);
    // The far side is seen from within: through an open end, or in the wall of a round hole.
    for (const double range : {(-b - root) / a, (-b + root) / a}) {
        if (!(range > kNearest && range < hit.range)) continue;
        const Eigen::Vector3d p = origin + range * direction;
        if (p.z() < 0.0 || p.z() > height_) continue;
        Eigen::Vector3d normal(p.x() / radius_, p.y() / radius_, 0.0);
        if (normal.dot(direction) > 0.0) normal = -normal;
        hit.range = range;
        hit.surface = this;
        hit.place = {radius_ * std::atan2(p.y(), p.x()), p.z()};
        hit.normal = T_world_surface_.linear() * normal;
        return true;
    }
    return false;
}

}  // namespace petal::simulation
