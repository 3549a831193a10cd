// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <cstdint>

namespace petal::simulation {

/// A number in [0, 1) that belongs to a cell of a grid: the same for the same cell and seed, and
/// unrelated to those of its neighbours (SplitMix64's finaliser; once only, for textures are asked
/// for millions of places).
inline double hash_noise(std::int64_t column, std::int64_t row, std::uint64_t seed) {
    std::uint64_t z = seed + static_cast<std::uint64_t>(column) * 0x9E3779B97F4A7C15ULL +
                      static_cast<std::uint64_t>(row) * 0xC2B2AE3D27D4EB4FULL;
    z = (z ^ (z >> 30U)) * 0xBF58476D1CE4E5B9ULL;
    z = (z ^ (z >> 27U)) * 0x94D049BB133111EBULL;
    const std::uint64_t mixed = z ^ (z >> 31U);
    return static_cast<double>(mixed >> 11U) * 0x1.0p-53;
}

}  // namespace petal::simulation
