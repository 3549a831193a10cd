// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <Eigen/Geometry>

#include "simulation/scene/materials.hpp"
#include "simulation/world/world.hpp"

namespace petal::simulation {

/// Builds objects out of surfaces of one kind.
class SolidBuilder {
   public:
    SolidBuilder(World& world, Kind kind) : world_(world), kind_(kind) {}

    /// A rectangle. Its frame, and that of its texture: origin at the upper left corner, x right,
    /// y down, z away from who looks at it.
    void panel(const Eigen::Isometry3d& T_world_panel, double width, double height,
               const SharedTexture& texture) const;
    /// An upright box of `size` (x, y, z). Its frame: origin in the middle of the lower face, z up.
    void box(const Eigen::Isometry3d& T_world_box, const Eigen::Vector3d& size,
             const SharedTexture& texture) const;
    /// A round bar between two points, its ends open.
    void bar(const Eigen::Vector3d& from, const Eigen::Vector3d& to, double radius,
             const SharedTexture& texture) const;

   private:
    World& world_;
    Kind kind_;
};

/// An upright frame: z up, turned left by `yaw` rad.
Eigen::Isometry3d upright(const Eigen::Vector3d& place, double yaw);

}  // namespace petal::simulation
