// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulation/camera/shading.hpp"

#include <algorithm>

namespace petal::simulation {
namespace {

constexpr double kHorizon = 1e6;  // m: beyond every scene

}  // namespace

Shading::Shading(const World& world, const Light& light, const Eigen::Isometry3d& T_world_camera)
    : world_(world), light_(light), T_world_camera_(T_world_camera) {
    light_.to_lamp.normalize();
}

Sight Shading::seen(const Eigen::Vector3d& direction) const {
    const Ray along = ray(direction);
    const Hit hit = world_.cast(along, kHorizon);
    if (hit.surface == nullptr) return {light_.sky.reverse(), nullptr, false};
    const Ray to_lamp{along.origin + hit.range * along.direction, light_.to_lamp};
    return shaded(hit, hit.normal.dot(light_.to_lamp) > 0.0 && !world_.blocked(to_lamp, kHorizon));
}

Sight Shading::seen(const Eigen::Vector3d& direction, const Sight& near) const {
    Hit hit;
    if (near.surface == nullptr || !near.surface->cast(ray(direction), hit)) return seen(direction);
    return shaded(hit, near.lit);
}

Sight Shading::shaded(const Hit& hit, bool lit) const {
    float light = light_.ambient;
    if (lit)
        light += light_.lamp * static_cast<float>(std::max(0.0, hit.normal.dot(light_.to_lamp)));
    return {light * hit.surface->look(hit.place).colour.reverse(), hit.surface, lit};
}

}  // namespace petal::simulation
