// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <Eigen/Geometry>
#include <memory>
#include <utility>
#include <vector>

#include "simulation/world/texture.hpp"

namespace petal::simulation {

/// Rectangles of other textures on a ground: posters, prints on a board, a board's look-alike.
class OverlayTexture final : public Texture {
   public:
    struct Part {
        Eigen::AlignedBox2d box;                 ///< m, on the surface
        std::shared_ptr<const Texture> texture;  ///< its places count from the box's upper left
    };
    /// Where parts overlap, the first one is seen.
    OverlayTexture(std::shared_ptr<const Texture> ground, std::vector<Part> parts)
        : ground_(std::move(ground)), parts_(std::move(parts)) {}
    Look at(const Eigen::Vector2d& place) const override {
        for (const Part& part : parts_)
            if (part.box.contains(place)) return part.texture->at(place - part.box.min());
        return ground_->at(place);
    }

   private:
    std::shared_ptr<const Texture> ground_;
    std::vector<Part> parts_;
};

}  // namespace petal::simulation
