// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include <algorithm>
#include <cmath>
#include <vector>

#include "detectors/detail/image_template_fit.hpp"

namespace petal {

namespace {

/// px: no photo's edge points scatter less.
constexpr double kLeastEdgeSigma = 0.03;
/// An edge of strength s lies where it seems to within this times noise / s, px: for the sampler's
/// filter of 1 px and a lens that blurs by 0.7 px.
constexpr double kNoiseToPlace = 1.4;
constexpr double kInPlacePx = 0.5;        ///< px, and
constexpr double kInPlaceSigmas = 2.5;    ///< of a sample's noise
constexpr double kLeastNoiseRatio = 1.0;  ///< of the noise

}  // namespace

double edge_sigma(double noise, double strength) {
    return std::hypot(kLeastEdgeSigma, kNoiseToPlace * noise / std::max(strength, 1e-3));
}

void TemplateFit::count(FittedBoard& board, const EdgeReach& reach) const {
    board.sides.resize(model_.sides().size());
    std::vector<double> sums(board.sides.size(), 0.0), seen(board.sides.size(), 0.0);
    for (const EdgeSample& sample : board.samples) {
        FittedSide& side = board.sides[sample.side];
        if (!sample.in_image) continue;
        ++side.samples;
        const double range = reach.range(model_.hole_size() * sample.px_per_m);
        const bool weak =
            sample.strength < kLeastNoiseRatio * noise_ ||
            (!sample.outline && sample.strength < kLeastEdgeShare * board.usual_strength);
        if (!sample.seen || weak) {
            side.chance += std::min(1.0, kInPlacePx / range);
            continue;
        }
        const double off = sample.offset - sample.shifted(board.shifts);
        const double allowed =
            std::hypot(kInPlacePx, kInPlaceSigmas * edge_sigma(noise_, sample.strength));
        side.in_place += std::abs(off) < allowed ? 1 : 0;
        side.chance += std::min(1.0, allowed / range);
        sums[sample.side] += off;
        seen[sample.side] += 1.0;
    }
    for (std::size_t s = 0; s < board.sides.size(); ++s)
        board.sides[s].offset_px = sums[s] / std::max(seen[s], 1.0);
}

double TemplateFit::holes_in_place(const FittedBoard& board) const {
    EdgesInPlace holes;
    for (std::size_t s = 0; s < board.sides.size(); ++s)
        if (!model_.sides()[s].outline) board.sides[s].add_to(holes);
    return holes.share();
}

}  // namespace petal
