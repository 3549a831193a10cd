// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <cmath>
#include <cstdint>
#include <random>

namespace petal::simulation {

/// Engines have the type of run.rng(). The distributions are written out here because those of the
/// standard library may differ from one to the next: one seed means the same numbers everywhere.
using Engine = std::mt19937_64;

/// A seed for stream `index` (a message, a row of an image) of what `seed` seeds: neighbouring
/// indices and seeds give unrelated ones (the finaliser of SplitMix64).
inline std::uint64_t mix(std::uint64_t seed, std::uint64_t index) {
    std::uint64_t z = seed + (index + 1) * 0x9E3779B97F4A7C15ULL;
    for (int round = 0; round < 2; ++round) {
        z = (z ^ (z >> 30U)) * 0xBF58476D1CE4E5B9ULL;
        z = (z ^ (z >> 27U)) * 0x94D049BB133111EBULL;
        z ^= z >> 31U;
    }
    return z;
}

/// In [low, high). Takes one number of the engine.
inline double uniform(Engine& engine, double low, double high) {
    return low + (high - low) * (static_cast<double>(engine() >> 11U) * 0x1.0p-53);
}

/// Around 0. Takes two numbers of the engine, always (Box and Muller's transform).
inline double normal(Engine& engine, double sigma) {
    constexpr double kTurn = 6.283185307179586476925;
    const double radius = std::sqrt(-2.0 * std::log(1.0 - uniform(engine, 0.0, 1.0)));
    return sigma * radius * std::cos(kTurn * uniform(engine, 0.0, 1.0));
}

}  // namespace petal::simulation
