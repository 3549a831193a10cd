// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <algorithm>

#include "simulation/world/texture.hpp"

namespace petal::simulation {

/// `share` 0 is `low`, 1 is `high`; between them linear.
inline Look mix_looks(const Look& low, const Look& high, double share) {
    const auto t = static_cast<float>(share);
    return {low.colour + t * (high.colour - low.colour),
            low.reflectivity + t * (high.reflectivity - low.reflectivity)};
}

/// The same look, lighter or darker; no share of it above 1.
inline Look scale_look(const Look& look, double factor) {
    const auto f = static_cast<float>(factor);
    return {(f * look.colour).cwiseMin(1.0F), std::min(1.0F, f * look.reflectivity)};
}

}  // namespace petal::simulation
