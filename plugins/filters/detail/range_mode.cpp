// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "filters/detail/range_mode.hpp"

#include <algorithm>
#include <cmath>

namespace petal {
namespace {

constexpr std::int32_t kBinsOfSigma = 4;
constexpr std::int32_t kHalfKernel = 2 * kBinsOfSigma;
constexpr std::int32_t kKernel = 2 * kHalfKernel;
/// The strip behind the kernel that it is compared with, up to five sigma behind its centre.
constexpr std::int32_t kStrip = 3 * kBinsOfSigma;
constexpr int kShifts = 5;
/// 3 km for a noise of 12 mm: ranges farther in front are counted there.
constexpr std::int32_t kMostBins = 1 << 20;

}  // namespace

ModeFinder::Bin ModeFinder::count_in_bins(const std::vector<float>& ranges, float nearest,
                                          float limit) {
    const float per_metre = static_cast<float>(kBinsOfSigma) / noise_;
    const auto bin_of = [&](float range) {
        return static_cast<Bin>(std::max(0.0F, range - nearest) * per_metre);
    };
    const Bin last = bin_of(limit);
    dense_ = static_cast<std::size_t>(last) < 4 * ranges.size() + 256;
    before_.clear();
    if (dense_) {
        before_.resize(static_cast<std::size_t>(last) + 2);
        for (const float range : ranges)
            if (range <= limit) ++before_[static_cast<std::size_t>(bin_of(range))].count;
        Before sum;
        for (Bin bin = 0; bin <= last; ++bin) {
            Before& here = before_[static_cast<std::size_t>(bin)];
            const Before next{sum.count + here.count,
                              sum.bins + std::int64_t{bin} * std::int64_t{here.count}};
            here = sum;
            sum = next;
        }
        before_.back() = sum;
        return last;
    }
    bins_.clear();
    for (const float range : ranges)
        if (range <= limit) bins_.push_back(bin_of(range));
    std::sort(bins_.begin(), bins_.end());
    Before sum;
    for (const Bin bin : bins_) {
        before_.push_back(sum);
        ++sum.count;
        sum.bins += bin;
    }
    before_.push_back(sum);
    return last;
}

std::size_t ModeFinder::place(Bin bin) const {
    if (dense_) return std::min(static_cast<std::size_t>(std::max(bin, 0)), before_.size() - 1);
    return static_cast<std::size_t>(std::lower_bound(bins_.begin(), bins_.end(), bin) -
                                    bins_.begin());
}

ModeFinder::Bin ModeFinder::next_filled(Bin bin) const {
    std::size_t at = place(bin);
    if (!dense_) return at < bins_.size() ? bins_[at] : kMostBins;
    while (at + 1 < before_.size() && before_[at + 1].count == before_[at].count) ++at;
    return at + 1 < before_.size() ? static_cast<Bin>(at) : kMostBins;
}

RangeMode ModeFinder::around(const std::vector<float>& ranges, float centre) const {
    const float half = noise_ * static_cast<float>(kHalfKernel) / static_cast<float>(kBinsOfSigma);
    RangeMode mode;
    float sum = 0.0F, squares = 0.0F;
    for (const float range : ranges) {
        const float offset = range - centre;
        if (std::abs(offset) > half) continue;
        sum += offset;
        squares += offset * offset;
        ++mode.count;
    }
    if (mode.count == 0) return mode;
    const float mean = sum / static_cast<float>(mode.count);
    mode.centre = centre + mean;
    mode.deviation =
        std::sqrt(std::max(0.0F, squares / static_cast<float>(mode.count) - mean * mean));
    return mode;
}

std::optional<RangeMode> ModeFinder::nearest_mode(const std::vector<float>& ranges, float nearest,
                                                  std::size_t fewest, float last) {
    const float width = noise_ / static_cast<float>(kBinsOfSigma);
    // A mode wanders by less than half a kernel a shift; most stay within one.
    const float limit = last + static_cast<float>(kKernel + kHalfKernel + kStrip) * width;
    const float origin = std::max(nearest, limit - static_cast<float>(kMostBins - 1) * width);
    count_in_bins(ranges, origin, limit);
    const auto last_begin = static_cast<Bin>(std::max(0.0F, last - origin) / width);
    if (last < origin) return std::nullopt;
    for (Bin bin = next_filled(0); bin <= last_begin; bin = next_filled(bin)) {
        Bin begin = bin++;
        if (before(begin + kKernel).count - before(begin).count < fewest) continue;
        std::uint32_t count = 0;
        for (int shift = 0; shift < kShifts; ++shift) {
            const Before &first = before(begin), &end = before(begin + kKernel);
            count = end.count - first.count;
            if (count == 0) break;
            // The mean of the bins' middles, rounded, becomes the kernel's.
            const auto middle = static_cast<Bin>((end.bins - first.bins + count) / count);
            const Bin moved = middle - kHalfKernel;
            if (moved == begin) break;
            begin = moved;
        }
        const std::uint32_t all = before(begin + kKernel).count;
        count = all - before(begin).count;
        const std::uint32_t behind = before(begin + kKernel + kStrip).count - all;
        // The strip is 3/4 as wide as the kernel: this asks for twice its density.
        if (count >= fewest && 3 * count >= 8 * behind)
            return around(ranges, origin + static_cast<float>(begin + kHalfKernel) * width);
        // Go on behind the place that was no surface.
        bin = std::max(bin, begin + kHalfKernel + 1);
    }
    return std::nullopt;
}

}  // namespace petal
