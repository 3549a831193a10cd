// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "filters/nearest_points.hpp"

#include <algorithm>
#include <cstdint>
#include <vector>

#include "filters/detail/angular_cells.hpp"
#include "filters/detail/write_subset.hpp"
#include "petal/calibration/angles.hpp"
#include "petal/calibration/for_pieces.hpp"
#include "petal/printed.hpp"

namespace petal {

void NearestPoints::describe(Spec<Params>& s) {
    s.summary(
        "Keeps the points as near as the nearest one of their cell of azimuth and elevation.");
    s.doc(
        R"(The step to margin points as the program of the letter's authors takes it, where the letter (section III.B.1)
clusters with mean shift: space is cut into cells of azimuth and elevation, `margin_step_deg` wide; in a cell whose farthest
point lies at least `range_threshold` behind its nearest one, the points at most `distance` behind the nearest stay. All others go, and
with them every cell of even depth.

One point decides for its cell. The nearest of many is drawn towards the sensor by the noise of the range (by 2 to 3 sigma of some hundred
points), so on a surface with a noise of 2 cm only the foremost part of the points stays, in front of the true surface; and
a vacant point in front of all others, of an edge that a neighbouring cell holds, takes the cell for itself.

Simplified against the program: its cells overlap (each is 2.8 steps wide), here each point lies in one cell; and its
later passes over the frontier are not part of this stage. A point in the origin has no direction and goes.)");
    s.role("outlier_remover");
    s.reads<Cloud>("cloud", "points in the LiDAR frame");
    s.writes<Cloud>("cloud", "the points that stay, in their order");
    s.param("margin_step_deg", &Params::margin_step_deg)
        .unit("deg")
        .within(0.01, 10.0)
        .doc("width of a cell, in azimuth and elevation");
    s.param("distance", &Params::distance)
        .unit("m")
        .within(0.0, 10.0)
        .doc("points at most so far behind the nearest of their cell stay");
    s.param("range_threshold", &Params::range_threshold)
        .unit("m")
        .within(0.0, 100.0)
        .doc("depth that a cell must span, else all its points go; 0: every cell counts");
}

void NearestPoints::run(Run& run) {
    constexpr std::size_t kCells = 1024;  // a piece of work
    const auto& cloud = run.in<Cloud>("cloud");
    std::vector<std::uint8_t> stays(cloud.size(), 0);
    const AngularCells cells(*cloud.points, params_.margin_step_deg / kDegrees, run);
    const auto& points = cells.points();
    for_pieces(run, cells.size(), kCells, [&](std::size_t begin, std::size_t end) {
        for (std::size_t cell = begin; cell < end; ++cell) {
            const auto first = points.begin() + cells.begin(cell);
            const auto last = points.begin() + cells.begin(cell + 1);
            const auto [nearest, farthest] = std::minmax_element(
                first, last, [](const auto& a, const auto& b) { return a.range < b.range; });
            const double front = nearest->range;
            if (farthest->range - front < params_.range_threshold) continue;
            for (auto point = first; point != last; ++point)
                stays[point->index] = point->range - front <= params_.distance ? 1 : 0;
        }
    });
    std::vector<std::uint32_t> kept;
    std::size_t finite = 0;
    for (std::size_t i = 0; i < stays.size(); ++i) {
        if (stays[i] != 0) kept.push_back(static_cast<std::uint32_t>(i));
        if (is_finite(cloud, i)) ++finite;
    }
    write_subset(run, cloud, kept, finite,
                 {"the nearest points of cells at margins", "",
                  printed("range_threshold %g m in cells of margin_step_deg %g",
                          params_.range_threshold, params_.margin_step_deg),
                  "lower range_threshold, widen the cells, or give more seconds of data"});
}

}  // namespace petal
