// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <cstdint>

#include "simulation/world/random.hpp"

namespace petal::simulation {

/// A number in [0, 1) that belongs to a cell of a grid: the same for the same cell and seed, and
/// unrelated to those of its neighbours.
inline double hash_noise(std::int64_t column, std::int64_t row, std::uint64_t seed) {
    const std::uint64_t mixed =
        mix(mix(seed, static_cast<std::uint64_t>(column)), static_cast<std::uint64_t>(row));
    return static_cast<double>(mixed >> 11U) * 0x1.0p-53;
}

}  // namespace petal::simulation
