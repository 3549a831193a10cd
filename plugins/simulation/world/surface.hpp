// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <limits>
#include <memory>
#include <utility>

#include "simulation/world/texture.hpp"

namespace petal::simulation {

struct Ray {
    Eigen::Vector3d origin;     ///< m, world frame
    Eigen::Vector3d direction;  ///< unit length
};

/// What a surface belongs to: the labels of points come from it.
enum class Kind : std::uint8_t { background, board, foreground };

class Surface;

/// Where a ray first meets a surface.
struct Hit {
    double range = std::numeric_limits<double>::infinity();  ///< m along the ray
    const Surface* surface = nullptr;
    Eigen::Vector2d place =
        Eigen::Vector2d::Zero();  ///< m, on the surface: where its texture is read
    Eigen::Vector3d normal =
        Eigen::Vector3d::Zero();  ///< unit, world frame, towards the ray's origin
};

/// Something that light and beams meet, seen from both sides. World frame, metres.
class Surface {
   public:
    Surface(std::shared_ptr<const Texture> texture, Kind kind)
        : texture_(std::move(texture)), kind_(kind) {}
    virtual ~Surface() = default;
    Surface(const Surface&) = delete;
    Surface& operator=(const Surface&) = delete;

    /// Sets `hit` and answers true where the ray meets the surface nearer than hit.range, and not
    /// nearer than a micrometre.
    virtual bool cast(const Ray& ray, Hit& hit) const = 0;
    virtual Eigen::AlignedBox3d bounds() const = 0;

    Look look(const Eigen::Vector2d& place) const { return texture_->at(place); }
    Kind kind() const { return kind_; }

   private:
    std::shared_ptr<const Texture> texture_;
    Kind kind_;
};

}  // namespace petal::simulation
