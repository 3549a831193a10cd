// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <cstdint>

#include "simulation/world/texture.hpp"

namespace petal::simulation {

/// Grass, asphalt, concrete, plaster: between two looks by value noise, that is random numbers on a
/// grid, interpolated smoothly. Each octave halves the grid and the share that it has.
class NoiseTexture final : public Texture {
   public:
    /// `size`: side of the coarsest cells, m. `octaves`: 1 to 8.
    NoiseTexture(const Look& low, const Look& high, double size, int octaves, std::uint64_t seed);
    Look at(const Eigen::Vector2d& place) const override;

   private:
    double value(const Eigen::Vector2d& place) const;

    Look low_, high_;
    double size_;
    int octaves_;
    std::uint64_t seed_;
};

}  // namespace petal::simulation
