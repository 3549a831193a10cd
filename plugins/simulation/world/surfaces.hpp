// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <memory>
#include <vector>

#include "simulation/world/surface.hpp"

namespace petal::simulation {

/// Part of a plane, bounded by a polygon and with holes in it. Its own frame: z = 0, and places of
/// the texture are (x, y).
class PlanarSurface final : public Surface {
   public:
    using Polygon = std::vector<Eigen::Vector2d>;
    struct Circle {
        Eigen::Vector2d centre;
        double radius;
    };
    struct Shape {
        Polygon outline;             ///< simple, at least three corners
        std::vector<Polygon> holes;  ///< inside it
        std::vector<Circle> round_holes;
    };

    PlanarSurface(const Eigen::Isometry3d& T_world_surface, Shape shape,
                  std::shared_ptr<const Texture> texture, Kind kind);
    bool cast(const Ray& ray, Hit& hit) const override;
    Eigen::AlignedBox3d bounds() const override { return bounds_; }

    /// A rectangle from the origin to (width, height).
    static Shape rectangle(double width, double height);

   private:
    bool covers(const Eigen::Vector2d& p) const;

    Shape shape_;
    bool is_rectangle_;
    Eigen::AlignedBox2d outline_box_;
    Eigen::Vector3d origin_, x_, y_, normal_;  ///< of its frame, in the world
    Eigen::AlignedBox3d bounds_;
};

/// The side of an upright or lying cylinder: axis z from 0 to `height`, in its own frame. Places
/// are (arc length, z).
class CylinderSurface final : public Surface {
   public:
    CylinderSurface(const Eigen::Isometry3d& T_world_surface, double radius, double height,
                    std::shared_ptr<const Texture> texture, Kind kind);
    bool cast(const Ray& ray, Hit& hit) const override;
    Eigen::AlignedBox3d bounds() const override { return bounds_; }

   private:
    Eigen::Isometry3d T_world_surface_, T_surface_world_;
    double radius_, height_;
    Eigen::AlignedBox3d bounds_;
};

}  // namespace petal::simulation
