// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "filters/detail/range_mode.hpp"

#include <algorithm>
#include <cmath>

namespace petal {
namespace {

constexpr float kHalfWidth = 2.0F;  ///< of the mean shift's flat kernel, in sigma
constexpr float kBehind = 5.0F;     ///< sigma: as far back a mode is compared with what follows
constexpr int kShifts = 5;

using At = std::vector<float>::const_iterator;

/// Mean shift from `start` to where the kernel stays, over ascending ranges.
RangeMode shifted(At begin, At end, float start, float half) {
    RangeMode mode;
    mode.centre = start;
    for (int shift = 0; shift < kShifts; ++shift) {
        const auto first = std::lower_bound(begin, end, mode.centre - half);
        float sum = 0.0F, squares = 0.0F;
        mode.count = 0;
        for (auto range = first; range != end && *range <= mode.centre + half; ++range) {
            const float offset = *range - mode.centre;
            sum += offset;
            squares += offset * offset;
            ++mode.count;
        }
        if (mode.count == 0) break;
        const float mean = sum / static_cast<float>(mode.count);
        const float variance = squares / static_cast<float>(mode.count) - mean * mean;
        mode.centre += mean;
        mode.deviation = std::sqrt(std::max(0.0F, variance));
        if (std::abs(mean) < 0.05F * half) break;
    }
    return mode;
}

}  // namespace

std::optional<RangeMode> nearest_mode(std::vector<float>& ranges, float noise, std::size_t fewest,
                                      float last) {
    const float half = kHalfWidth * noise;
    // A mode wanders by less than half a kernel a shift; most stay within one.
    const float limit = last + 2.0F * half + kBehind * noise;
    const auto all = std::partition(ranges.begin(), ranges.end(),
                                    [limit](float range) { return range <= limit; });
    std::sort(ranges.begin(), all);
    const auto size = static_cast<std::size_t>(all - ranges.begin());
    const auto passing = [](std::size_t inside, std::ptrdiff_t behind) {
        // The strip behind is 3/4 as wide as the kernel: this asks for twice its density.
        return 3 * inside >= 8 * static_cast<std::size_t>(behind);
    };
    for (std::size_t i = 0; i + fewest <= size && ranges[i] <= last; ++i) {
        if (ranges[i + fewest - 1] - ranges[i] > 2.0F * half) continue;
        const RangeMode mode = shifted(ranges.begin(), all, ranges[i] + half, half);
        const auto end = std::upper_bound(ranges.begin(), all, mode.centre + half);
        const auto behind = std::upper_bound(end, all, mode.centre + kBehind * noise);
        if (mode.count >= fewest && passing(mode.count, behind - end)) return mode;
        // Go on behind the place that was no surface.
        const auto next = std::upper_bound(ranges.begin(), all, mode.centre);
        i = std::max(i, static_cast<std::size_t>(next - ranges.begin()));
    }
    return std::nullopt;
}

}  // namespace petal
