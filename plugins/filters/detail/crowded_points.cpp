// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "filters/detail/crowded_points.hpp"

#include <cmath>

#include "filters/detail/space_cells.hpp"
#include "filters/detail/write_subset.hpp"
#include "petal/calibration/for_pieces.hpp"

namespace petal {
namespace {

constexpr std::size_t kCellsAtOnce = 2048;
constexpr int kCellsOfABall = 2;  ///< of distance / sqrt(3), to each side

}  // namespace

std::vector<std::uint32_t> crowded_points(const Cloud& cloud,
                                          const std::vector<std::uint32_t>& indices,
                                          double distance, std::size_t enough, const Run& run) {
    const auto nearer = [square = distance * distance](const SpaceCells::Point& a,
                                                       const SpaceCells::Point& b) {
        const double dx = static_cast<double>(a.x) - static_cast<double>(b.x);
        const double dy = static_cast<double>(a.y) - static_cast<double>(b.y);
        const double dz = static_cast<double>(a.z) - static_cast<double>(b.z);
        return dx * dx + dy * dy + dz * dz < square;
    };
    // A trace smaller, lest two points of one cell are too far apart by rounding.
    const SpaceCells cells(cloud, indices, distance / std::sqrt(3.0) * (1.0 - 1e-9), run);
    std::vector<std::uint8_t> stays(cloud.size(), 0);
    for_pieces(run, cells.size(), kCellsAtOnce, [&](std::size_t begin, std::size_t end) {
        SpaceCells::Around around(cells, kCellsOfABall);
        for (std::size_t cell = begin; cell < end; ++cell) {
            const SpaceCells::Points own = cells.points(cell);
            const bool full = own.size() > enough;
            const std::vector<SpaceCells::Points> none;
            const auto& others = full ? none : around.of(cell);
            for (const SpaceCells::Point& point : own) {
                std::size_t found = own.size() - 1;
                for (std::size_t k = 0; k < others.size() && found < enough; ++k)
                    for (const SpaceCells::Point& other : others[k])
                        if (nearer(point, other) && ++found == enough) break;
                stays[point.index] = found >= enough ? 1 : 0;
            }
        }
    });
    std::vector<std::uint32_t> kept;
    for (const std::uint32_t i : indices)
        if (stays[i] != 0) kept.push_back(i);
    return kept;
}

void write_crowded_points(Run& run, double distance, int enough, const std::string& threshold,
                          const std::string& hint) {
    const auto& cloud = run.in<Cloud>("cloud");
    const auto finite = finite_points(cloud);
    const auto kept =
        crowded_points(cloud, finite, distance, static_cast<std::size_t>(enough), run);
    write_subset(run, cloud, kept, finite.size(), {"points with neighbours", "", threshold, hint});
}

}  // namespace petal
