// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulation/world/tile_texture.hpp"

#include "simulation/world/hash_noise.hpp"
#include "simulation/world/look_mix.hpp"

namespace petal::simulation {

Look TileTexture::at(const Eigen::Vector2d& place) const {
    const double row = std::floor(place.y() / layout_.height);
    const double along = place.x() / layout_.width - row * layout_.shift;
    const double column = std::floor(along);
    const double x = (along - column) * layout_.width;
    const double y = place.y() - row * layout_.height;
    if (x < layout_.joint || y < layout_.joint) return joint_;
    const double lightness =
        hash_noise(static_cast<std::int64_t>(column), static_cast<std::int64_t>(row), seed_);
    return scale_look(tile_, 1.0 + layout_.variation * (2.0 * lightness - 1.0));
}

}  // namespace petal::simulation
