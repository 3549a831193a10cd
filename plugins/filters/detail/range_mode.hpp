// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace petal {

/// Points at about one range.
struct RangeMode {
    float centre = 0.0F;     ///< m
    float deviation = 0.0F;  ///< m, of its points
    std::size_t count = 0;
};

/// Finds where ranges crowd as they do on a surface, by mean shift with a flat kernel of two
/// standard deviations to each side. Ranges are counted in bins of a quarter of a deviation, so the
/// time is linear in them, unless they lie so far apart that sorting is faster.
class ModeFinder {
   public:
    /// \param noise of ranges, m, 1 sigma
    explicit ModeFinder(float noise) : noise_(noise) {}

    /// The nearest mode with at least `fewest` ranges, and twice as many as a smear that goes on
    /// behind it (vacant points) would have there. None where there is no such place that begins
    /// before `last`.
    /// \param ranges m, in any order
    /// \param nearest the least of them
    std::optional<RangeMode> nearest_mode(const std::vector<float>& ranges, float nearest,
                                          std::size_t fewest, float last);

   private:
    using Bin = std::int32_t;
    /// Of the ranges before a bin.
    struct Before {
        std::uint32_t count = 0;
        std::int64_t bins = 0;  ///< sum of their bins
    };
    /// Gives the last bin.
    Bin count_in_bins(const std::vector<float>& ranges, float nearest, float limit);
    std::size_t place(Bin bin) const;
    const Before& before(Bin bin) const { return before_[place(bin)]; }
    Bin next_filled(Bin bin) const;
    RangeMode around(const std::vector<float>& ranges, float centre) const;

    float noise_;
    bool dense_ = true;           ///< before_ has an element for every bin, else for those filled
    std::vector<Bin> bins_;       ///< where not dense: those filled, ascending
    std::vector<Before> before_;  ///< and one more, of all
};

}  // namespace petal
