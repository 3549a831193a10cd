// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "filters/detail/space_cells.hpp"
#include "petal/calibration/for_pieces.hpp"

#include <tbb/parallel_sort.h>

#include <algorithm>
#include <cmath>
#include <tuple>

namespace petal {
namespace {

constexpr std::size_t kPiece = 16384;

struct PlacedPoint {
    std::array<std::int32_t, 3> place;
    std::uint32_t index;
};

bool earlier(const PlacedPoint& a, const PlacedPoint& b) {
    return std::tie(a.place[0], a.place[1], a.place[2], a.index) <
           std::tie(b.place[0], b.place[1], b.place[2], b.index);
}

std::int32_t place_of(float coordinate, double edge) {
    constexpr double kLast = 1 << 30;
    return static_cast<std::int32_t>(std::clamp(std::floor(coordinate / edge), -kLast, kLast));
}

}  // namespace

SpaceCells::SpaceCells(const Cloud& cloud, const std::vector<std::uint32_t>& indices, double edge,
                       const Run& run)
    : points_(indices.size()) {
    const auto& xs = cloud.points->getPointsBufferRef_x();
    const auto& ys = cloud.points->getPointsBufferRef_y();
    const auto& zs = cloud.points->getPointsBufferRef_z();
    std::vector<PlacedPoint> placed(indices.size());
    for_pieces(run, placed.size(), kPiece, [&](std::size_t begin, std::size_t end) {
        for (std::size_t k = begin; k < end; ++k) {
            const std::uint32_t i = indices[k];
            placed[k] = {{place_of(xs[i], edge), place_of(ys[i], edge), place_of(zs[i], edge)}, i};
        }
    });
    // No two are equal, as the indices differ: any sort gives the same order.
    on_run_threads(run, [&] { tbb::parallel_sort(placed.begin(), placed.end(), earlier); });
    for (std::size_t k = 0; k < placed.size(); ++k)
        if (k == 0 || placed[k].place != placed[k - 1].place)
            cells_.push_back({placed[k].place, static_cast<std::uint32_t>(k)});
    for_pieces(run, placed.size(), kPiece, [&](std::size_t begin, std::size_t end) {
        for (std::size_t k = begin; k < end; ++k) {
            const std::uint32_t i = placed[k].index;
            points_[k] = {xs[i], ys[i], zs[i], i};
        }
    });
}

SpaceCells::Points SpaceCells::points(std::size_t cell) const {
    const std::size_t end = cell + 1 < cells_.size() ? cells_[cell + 1].begin : points_.size();
    return {points_.data() + cells_[cell].begin, points_.data() + end};
}

SpaceCells::Around::Around(const SpaceCells& cells, int reach) : cells_(&cells), reach_(reach) {}

const std::vector<SpaceCells::Points>& SpaceCells::Around::of(std::size_t cell) {
    found_.clear();
    const std::vector<Cell>& cells = cells_->cells_;
    const auto [x, y, z] = cells[cell].place;
    const bool first = next_.empty();
    const auto side = 2 * static_cast<std::size_t>(reach_) + 1;
    if (first) next_.resize(side * side);
    auto next = next_.begin();
    for (std::int32_t i = x - reach_; i <= x + reach_; ++i)
        for (std::int32_t j = y - reach_; j <= y + reach_; ++j, ++next) {
            const Place begin{i, j, z - reach_}, last{i, j, z + reach_};
            if (first)
                *next = static_cast<std::size_t>(
                    std::lower_bound(cells.begin(), cells.end(), begin,
                                     [](const Cell& a, const Place& b) { return a.place < b; }) -
                    cells.begin());
            while (*next < cells.size() && cells[*next].place < begin) ++*next;
            for (std::size_t at = *next; at < cells.size() && cells[at].place <= last; ++at)
                if (at != cell) found_.push_back(cells_->points(at));
        }
    return found_;
}

}  // namespace petal
