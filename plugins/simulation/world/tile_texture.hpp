// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <cstdint>

#include "simulation/world/random.hpp"
#include "simulation/world/texture.hpp"

namespace petal::simulation {

/// Tiles, paving stones, bricks, boards of a floor: rectangles with joints between them, each a
/// little lighter or darker than the others.
class TileTexture final : public Texture {
   public:
    struct Layout {
        double width = 0.3, height = 0.3;  ///< m, from joint to joint
        double joint = 0.005;              ///< m wide
        double shift =
            0.0;  ///< of each row against the one before, in tiles: 0.5 is a running bond
        double variation = 0.1;  ///< tiles differ by up to this share either way
    };
    TileTexture(const Look& tile, const Look& joint, const Layout& layout, std::uint64_t seed)
        : tile_(tile), joint_(joint), layout_(layout), seed_(mix(seed, 0)) {}
    Look at(const Eigen::Vector2d& place) const override;

   private:
    Look tile_, joint_;
    Layout layout_;
    std::uint64_t seed_;
};

}  // namespace petal::simulation
