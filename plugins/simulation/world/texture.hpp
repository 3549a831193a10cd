// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <Eigen/Core>
#include <cmath>
#include <memory>

namespace petal::simulation {

/// What a place of a surface sends back. Surfaces are diffuse (Lambert).
struct Look {
    Eigen::Vector3f colour =
        Eigen::Vector3f::Constant(0.5F);  ///< linear albedo: red, green, blue; 0 to 1
    float reflectivity = 0.5F;            ///< diffuse, at the LiDAR's wavelength (905 nm), 0 to 1
};

/// The pattern of a surface. Places are metres in the surface's own frame. Immutable.
class Texture {
   public:
    Texture() = default;
    virtual ~Texture() = default;
    Texture(const Texture&) = delete;
    Texture& operator=(const Texture&) = delete;
    virtual Look at(const Eigen::Vector2d& place) const = 0;
};

/// One look everywhere.
class PlainTexture final : public Texture {
   public:
    explicit PlainTexture(const Look& look) : look_(look) {}
    Look at(const Eigen::Vector2d&) const override { return look_; }

   private:
    Look look_;
};

/// Squares of two looks, `size` m wide, one corner at the origin: checkerboards, coarse tiles.
class CheckerTexture final : public Texture {
   public:
    CheckerTexture(const Look& first, const Look& second, double size)
        : first_(first), second_(second), size_(size) {}
    Look at(const Eigen::Vector2d& p) const override {
        const double cell = std::floor(p.x() / size_) + std::floor(p.y() / size_);
        return std::fmod(cell, 2.0) == 0.0 ? first_ : second_;
    }

   private:
    Look first_, second_;
    double size_;
};

}  // namespace petal::simulation
