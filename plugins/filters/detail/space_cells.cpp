// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "filters/detail/space_cells.hpp"

#include <tbb/parallel_sort.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <tuple>

#include "filters/detail/for_pieces.hpp"

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
    : order_(indices.size()) {
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
    tbb::task_arena(run.threads()).execute([&] {
        tbb::parallel_sort(placed.begin(), placed.end(), earlier);
    });
    for (std::size_t k = 0; k < placed.size(); ++k) {
        if (k == 0 || placed[k].place != placed[k - 1].place)
            cells_.push_back({placed[k].place, static_cast<std::uint32_t>(k)});
        order_[k] = placed[k].index;
    }
}

SpaceCells::Points SpaceCells::points(std::size_t cell) const {
    const std::size_t end = cell + 1 < cells_.size() ? cells_[cell + 1].begin : order_.size();
    return {order_.data() + cells_[cell].begin, order_.data() + end};
}

void SpaceCells::around(std::size_t cell, int reach, std::vector<Points>& found) const {
    found.clear();
    const auto [x, y, z] = cells_[cell].place;
    const auto before = [](const Cell& a, const std::array<std::int32_t, 3>& b) {
        return a.place < b;
    };
    for (std::int32_t i = x - reach; i <= x + reach; ++i)
        for (std::int32_t j = y - reach; j <= y + reach; ++j) {
            auto at = std::lower_bound(cells_.begin(), cells_.end(),
                                       std::array<std::int32_t, 3>{i, j, z - reach}, before);
            const std::array<std::int32_t, 3> last{i, j, z + reach};
            for (; at != cells_.end() && at->place <= last; ++at) {
                const auto other = static_cast<std::size_t>(at - cells_.begin());
                if (other != cell) found.push_back(points(other));
            }
        }
}

}  // namespace petal
