// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "filters/radius_outlier.hpp"

#include <cmath>
#include <cstdint>
#include <vector>

#include "filters/detail/cloud_subset.hpp"
#include "filters/detail/for_pieces.hpp"
#include "filters/detail/space_cells.hpp"
#include "petal/printed.hpp"

namespace petal {
namespace {

/// Counts neighbours in a ball, up to a number that is enough.
class BallCount {
   public:
    BallCount(const Cloud& cloud, double radius, std::size_t enough)
        : xs_(cloud.points->getPointsBufferRef_x()),
          ys_(cloud.points->getPointsBufferRef_y()),
          zs_(cloud.points->getPointsBufferRef_z()),
          square_(radius * radius),
          enough_(enough) {}

    /// Whether point i has enough neighbours: `sure` of them are known, the rest is looked for.
    bool reached(std::uint32_t i, std::size_t sure,
                 const std::vector<SpaceCells::Points>& around) const {
        for (const SpaceCells::Points& points : around)
            for (const std::uint32_t other : points) {
                if (sure >= enough_) return true;
                if (near(i, other)) ++sure;
            }
        return sure >= enough_;
    }

   private:
    bool near(std::uint32_t a, std::uint32_t b) const {
        const double dx = static_cast<double>(xs_[a]) - static_cast<double>(xs_[b]);
        const double dy = static_cast<double>(ys_[a]) - static_cast<double>(ys_[b]);
        const double dz = static_cast<double>(zs_[a]) - static_cast<double>(zs_[b]);
        return dx * dx + dy * dy + dz * dz <= square_;
    }

    const mrpt::aligned_std_vector<float>&xs_, &ys_, &zs_;
    double square_;
    std::size_t enough_;
};

}  // namespace

void RadiusOutlier::describe(Spec<Params>& s) {
    s.summary("Drops points that have too few neighbours inside a ball.");
    s.doc(
        R"(A point stays when at least `min_neighbours` other points lie within `radius` of it, at exactly `radius`
included. It takes lonely points: rain, dust, and the thinnest of the vacant points. It knows nothing of beams, so the dense part of the
curtain between a board and the wall behind stays, and thin surfaces far away, where the points are few, go.

A cell of radius / sqrt(3) lies within the ball of each of its points: those of a full cell stay without a
look at any distance, and only the points of sparse cells are compared with those of the cells around. So the
time grows linearly with the points, however dense the cloud is.)");
    s.role("outlier_remover");
    s.reads<Cloud>("cloud", "points in the LiDAR frame");
    s.writes<Cloud>("cloud", "the points that stay, in their order");
    s.param("radius", &Params::radius).unit("m").within(0.001, 10.0).doc("ball radius");
    s.param("min_neighbours", &Params::min_neighbours)
        .within(1, 1000)
        .doc("a point with fewer others in its ball goes");
}

void RadiusOutlier::run(Run& run) {
    constexpr std::size_t kCells = 256;  // a piece of work
    constexpr int kReach = 2;            // cells of radius / sqrt(3) that a ball reaches over
    const auto& cloud = run.in<Cloud>("cloud");
    const auto finite = finite_points(cloud);
    // A trace smaller, lest two points of one cell are farther apart than the radius by rounding.
    const double edge = params_.radius / std::sqrt(3.0) * (1.0 - 1e-9);
    const SpaceCells cells(cloud, finite, edge, run);
    const auto enough = static_cast<std::size_t>(params_.min_neighbours);
    const BallCount count(cloud, params_.radius, enough);
    std::vector<std::uint8_t> stays(cloud.size(), 0);
    for_pieces(run, cells.size(), kCells, [&](std::size_t begin, std::size_t end) {
        std::vector<SpaceCells::Points> around;
        for (std::size_t cell = begin; cell < end; ++cell) {
            const SpaceCells::Points own = cells.points(cell);
            const bool full = own.size() > enough;
            if (!full) cells.around(cell, kReach, around);
            for (const std::uint32_t i : own)
                stays[i] = full || count.reached(i, own.size() - 1, around) ? 1 : 0;
        }
    });
    std::vector<std::uint32_t> kept;
    kept.reserve(finite.size());
    for (const std::uint32_t i : finite)
        if (stays[i] != 0) kept.push_back(i);
    write_subset(
        run, cloud, kept, finite.size(),
        {"points with neighbours", "",
         printed("min_neighbours %d within radius %g m", params_.min_neighbours, params_.radius),
         "enlarge the radius, or give more seconds of data"});
}

}  // namespace petal
