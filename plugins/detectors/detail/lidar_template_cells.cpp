// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "detectors/detail/lidar_template_cells.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cstddef>
#include <unordered_map>

namespace petal {
namespace {

constexpr int kOffset = 1 << 20;
constexpr std::size_t kCellsPiece = std::size_t{1} << 19;
constexpr std::size_t kPointsOfCell = 16;  ///< room is made for so many; not a limit

/// The cells of some of the points, in the order of these.
struct CellsOfPiece {
    std::vector<PlateCell> cells;
    std::vector<std::uint64_t> keys;
    std::unordered_map<std::uint64_t, std::uint32_t> index;

    /// The reference holds until the next call.
    PlateCell& at(std::uint64_t key) {
        const auto [found, fresh] =
            index.try_emplace(key, static_cast<std::uint32_t>(cells.size()));
        if (fresh) {
            cells.emplace_back();
            keys.push_back(key);
        }
        return cells[found->second];
    }
};

CellsOfPiece cells_of(const mrpt::maps::CPointsMapXYZI& points, std::size_t begin, std::size_t end,
                      double size) {
    const auto& xs = points.getPointsBufferRef_x();
    const auto& ys = points.getPointsBufferRef_y();
    const auto& zs = points.getPointsBufferRef_z();
    const float scale = static_cast<float>(1.0 / size);
    const float most = static_cast<float>(kOffset - 2);
    CellsOfPiece piece;
    piece.index.reserve((end - begin) / kPointsOfCell);
    for (std::size_t i = begin; i < end; ++i) {
        const Eigen::Vector3f p(xs[i], ys[i], zs[i]);
        const Eigen::Vector3f scaled = scale * p;
        // With what is not finite this is false.
        if (!(scaled.cwiseAbs().maxCoeff() < most)) continue;
        piece.at(cell_key(scaled.array().floor().matrix().cast<int>())).add({p, 1});
    }
    return piece;
}

}  // namespace

std::uint64_t cell_key(const Eigen::Vector3i& at) {
    return (static_cast<std::uint64_t>(at.x() + kOffset) << 42) |
           (static_cast<std::uint64_t>(at.y() + kOffset) << 21) |
           static_cast<std::uint64_t>(at.z() + kOffset);
}

std::vector<PlateCell> gather_cells(const Cloud& cloud, double size, int least) {
    const std::size_t count = cloud.points->getPointsBufferRef_x().size();
    std::vector<CellsOfPiece> pieces((count + kCellsPiece - 1) / kCellsPiece);
    tbb::parallel_for(std::size_t{0}, pieces.size(), [&](std::size_t k) {
        pieces[k] =
            cells_of(*cloud.points, k * kCellsPiece, std::min(count, (k + 1) * kCellsPiece), size);
    });
    std::vector<PlateCell> cells;
    if (pieces.empty()) return cells;
    CellsOfPiece& all = pieces.front();
    for (std::size_t k = 1; k < pieces.size(); ++k)
        for (std::size_t i = 0; i < pieces[k].cells.size(); ++i)
            all.at(pieces[k].keys[i]).add(pieces[k].cells[i]);
    for (const PlateCell& cell : all.cells)
        if (cell.count >= least) cells.push_back(cell);
    return cells;
}

}  // namespace petal
