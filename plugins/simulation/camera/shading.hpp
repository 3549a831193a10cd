// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "simulation/camera/camera_simulation.hpp"

namespace petal::simulation {

/// What a camera sees along one ray.
struct Sight {
    Eigen::Vector3f radiance = Eigen::Vector3f::Zero();  ///< blue, green, red; linear
    const Surface* surface = nullptr;                    ///< null: the sky, or nothing
    bool lit = false;                                    ///< the lamp is seen from there
};

/// Light on diffuse surfaces: albedo * (ambient + lamp * max(0, n . l) * whether the lamp is seen).
/// No light goes from surface to surface but in the ambient part.
class Shading {
   public:
    Shading(const World& world, const Light& light, const Eigen::Isometry3d& T_world_camera);

    /// Along a direction in the camera's frame, of any length but zero.
    Sight seen(const Eigen::Vector3d& direction) const;
    /// The same close to `near`, where no other surface and no edge of a shadow is: much cheaper.
    Sight seen(const Eigen::Vector3d& direction, const Sight& near) const;
    /// Radiance of a white surface that faces the lamp: the unit for what is a contrast.
    float white() const { return light_.ambient + light_.lamp; }

   private:
    Ray ray(const Eigen::Vector3d& direction) const {
        return {T_world_camera_.translation(), (T_world_camera_.linear() * direction).normalized()};
    }
    Sight shaded(const Hit& hit, bool lit) const;

    const World& world_;
    Light light_;
    Eigen::Isometry3d T_world_camera_;
};

}  // namespace petal::simulation
