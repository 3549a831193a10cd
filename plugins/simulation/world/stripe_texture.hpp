// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include "simulation/world/texture.hpp"

namespace petal::simulation {

/// Stripes of two looks, `width` m wide each, at `angle` rad from the y axis.
class StripeTexture final : public Texture {
   public:
    StripeTexture(const Look& first, const Look& second, double width, double angle)
        : first_(first),
          second_(second),
          across_(std::cos(angle) / width, std::sin(angle) / width) {}
    Look at(const Eigen::Vector2d& place) const override {
        return std::fmod(std::floor(across_.dot(place)), 2.0) == 0.0 ? first_ : second_;
    }

   private:
    Look first_, second_;
    Eigen::Vector2d across_;  ///< stripes a metre
};

}  // namespace petal::simulation
