// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <cstddef>
#include <optional>
#include <vector>

namespace petal {

/// Points at about one range.
struct RangeMode {
    float centre = 0.0F;     ///< m
    float deviation = 0.0F;  ///< m, of its points
    std::size_t count = 0;
};

/// The nearest place where ranges crowd as they do on a surface, by mean shift: at least `fewest`
/// of them lie within two standard deviations `noise` of it, and twice as many as a smear that goes
/// on behind it (vacant points) would have there. None where there is no such place that begins
/// before `last`.
/// \param ranges m, in any order; put into another order
std::optional<RangeMode> nearest_mode(std::vector<float>& ranges, float noise, std::size_t fewest,
                                      float last);

}  // namespace petal
