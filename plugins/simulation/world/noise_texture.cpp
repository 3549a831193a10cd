// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulation/world/noise_texture.hpp"

#include "simulation/world/hash_noise.hpp"
#include "simulation/world/look_mix.hpp"
#include "simulation/world/random.hpp"

namespace petal::simulation {
namespace {

double smooth(double t) {
    return t * t * (3.0 - 2.0 * t);
}

double value_noise(const Eigen::Vector2d& p, std::uint64_t seed) {
    const double column = std::floor(p.x()), row = std::floor(p.y());
    const auto x = static_cast<std::int64_t>(column), y = static_cast<std::int64_t>(row);
    const double u = smooth(p.x() - column), v = smooth(p.y() - row);
    const double upper = (1.0 - u) * hash_noise(x, y, seed) + u * hash_noise(x + 1, y, seed);
    const double lower =
        (1.0 - u) * hash_noise(x, y + 1, seed) + u * hash_noise(x + 1, y + 1, seed);
    return (1.0 - v) * upper + v * lower;
}

}  // namespace

NoiseTexture::NoiseTexture(const Look& low, const Look& high, double size, int octaves,
                           std::uint64_t seed)
    : low_(low), high_(high), size_(size), octaves_(octaves), seed_(mix(seed, 0)) {}

double NoiseTexture::value(const Eigen::Vector2d& place) const {
    double sum = 0.0, shares = 0.0, share = 1.0, scale = 1.0 / size_;
    for (int octave = 0; octave < octaves_; ++octave) {
        sum += share * value_noise(scale * place, seed_ + static_cast<std::uint64_t>(octave));
        shares += share;
        share *= 0.5;
        scale *= 2.0;
    }
    return sum / shares;
}

Look NoiseTexture::at(const Eigen::Vector2d& place) const {
    return mix_looks(low_, high_, value(place));
}

}  // namespace petal::simulation
