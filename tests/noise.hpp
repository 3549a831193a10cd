// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include "petal/run.hpp"

// Noise that is the same with every standard library (std::normal_distribution is not).
namespace petal::testing {

inline double uniform(Rng& rng, double low, double high) {
    return low + (high - low) * static_cast<double>(rng() >> 11) * 0x1p-53;
}

/// Nearly Gaussian: a sum of twelve uniform numbers, so never beyond 6 sigma.
inline double normal(Rng& rng, double sigma) {
    double sum = 0.0;
    for (int i = 0; i < 12; ++i) sum += uniform(rng, -0.5, 0.5);
    return sigma * sum;
}

}  // namespace petal::testing
