// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "filters/observation_voxel.hpp"

#include <array>
#include <cmath>
#include <functional>
#include <unordered_set>

namespace petal {
namespace {

/// Indices of a cell along x, y, z. Whole numbers, but far points exceed any integer type.
using Cell = std::array<double, 3>;

struct CellHash {
    std::size_t operator()(const Cell& cell) const {
        const std::hash<double> hash;
        std::size_t sum = 0;
        for (const double index : cell) sum = sum * 0x9E3779B97F4A7C15U + hash(index);
        return sum;
    }
};

}  // namespace

void ObservationVoxel::describe(Spec<Params>& spec) {
    spec.summary("Thins clouds: keeps the first point in each cell of a grid.");
    spec.doc(
        R"(The cells are cubes, aligned with the axes of the sensor's own frame and with a corner
in its origin: point p lies in cell (floor(x / size), floor(y / size), floor(z / size)). Of the
points in a cell the first, in the cloud's order, stays as it is: unlike with an average, every
point that stays was measured, and its channels (intensity, colour, weight) are its own. A point
that is not finite goes. Each cloud is thinned by itself.

Filtered are the points maps of `CObservationPointCloud`, of any class. An observation that loses
no point, and any other observation, goes on as it is. Points in another form (raw Velodyne
packets, range images, 2-D scans) are not touched; the notes tell of which sensors.)");
    describe_common(spec);
    spec.param("size", &Params::size).unit("m").within(0.001, 1000.0).doc("edge of a cell");
}

void ObservationVoxel::mark(const mrpt::maps::CPointsMap& points, std::vector<bool>& drop) {
    const auto& xs = points.getPointsBufferRef_x();
    const auto& ys = points.getPointsBufferRef_y();
    const auto& zs = points.getPointsBufferRef_z();
    std::unordered_set<Cell, CellHash> taken;
    taken.reserve(drop.size());
    for (std::size_t i = 0; i < drop.size(); ++i) {
        if (drop[i]) continue;
        const Cell cell{std::floor(xs[i] / params_.size), std::floor(ys[i] / params_.size),
                        std::floor(zs[i] / params_.size)};
        if (!taken.insert(cell).second) drop[i] = true;
    }
}

}  // namespace petal
