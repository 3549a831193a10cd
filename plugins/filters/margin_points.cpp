// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "filters/margin_points.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "filters/detail/angular_cells.hpp"
#include "filters/detail/margin_cells.hpp"
#include "filters/detail/range_noise.hpp"
#include "filters/detail/write_subset.hpp"
#include "petal/calibration/angles.hpp"
#include "petal/calibration/cloud.hpp"
#include "petal/printed.hpp"

namespace petal {
namespace {

constexpr double kPointsInCell = 12.0;  ///< asked of an ordinary cell
constexpr double kSigmas = 6.0;         ///< of the noise make the threshold
constexpr double kAssumedNoise = 0.02;  ///< m, where it cannot be measured
constexpr double kLeastNoise = 0.002;   ///< m

}  // namespace

void MarginPoints::describe(Spec<Params>& s) {
    s.summary("Keeps the points at depth edges: the nearest surface of cells with depth.");
    s.doc(
        R"(Section III.B.1 of the letter, Algorithm 1, lines 1 to 5. The LiDAR's field of view is cut into cells of azimuth
and elevation. In a cell the *frontier* is the nearest range at which points crowd, by mean shift; where the cell's range of
depth exceeds `range_threshold`, the frontier's points within one standard deviation are margin points. All other points go.

Where the letter is silent, or its cells alone do not do (docs/margin_points.md tells why, and what was measured):

- **Step.** 0 derives it: 12 points in a cell at the density that the median point has around it, but no less than half of and no
  more than one and a half times the beam's longer side.
- **Threshold.** 0 derives it: six times the noise of ranges, which is the median over the cloud of how far points lie off local planes.
- **Window.** A cell is judged together with the eight around it, but gives its own points only, and of these those that
  have something behind the frontier within half a cell's diagonal and a third of the beam.
- **Slant.** Depth is measured along rays from a plane through the cell's frontier; its slope is what the cells two steps to
  either side tell. Where both sides bend away, the flatter side's counts; else an edge must be one with each slope. So
  floors and walls at grazing angles have none.
- **Surface or smear.** A frontier needs `min_points` points within two sigma, and twice the density of the strip behind it; vacant
  points between a board and a wall spread evenly and fail. At least two points must lie behind it by the threshold.

`window` 0 with a step and a threshold given is the letter's cell as it stands, but for slant and smear. Table I of the
letter: 0.2 m for boards before a distant background; boards nearer than that to a wall have no margin then.

Cells at azimuth +-180 deg do not meet: behind the sensor an edge on that line can be missed. An edge before nothing at all (open sky) has
no depth and is not found. A point at the origin has no direction and goes. Time and memory grow linearly with the points.)");
    s.role("outlier_remover");
    s.reads<Cloud>("cloud", "points in the LiDAR frame, its origin where the beams begin");
    s.writes<Cloud>("cloud", "the margin points, in their order");
    s.param("margin_step_deg", &Params::margin_step_deg)
        .unit("deg")
        .within(0.0, 10.0)
        .doc("delta_s: side of a cell in azimuth and elevation; 0: from the density and beam_deg");
    s.param("range_threshold", &Params::range_threshold)
        .unit("m")
        .within(0.0, 100.0)
        .doc("delta_range: a cell with more depth has an edge; 0: six times the measured noise");
    s.param("beam_deg", &Params::beam_deg)
        .unit("deg")
        .within(0.01, 10.0)
        .doc("the longer side of the beam's footprint: bounds the step that is derived");
    s.param("window", &Params::window)
        .within(0, 1)
        .doc("cells to each side that are looked at when a cell is judged; 0: the cell alone");
    s.param("min_points", &Params::min_points)
        .within(1, 1000)
        .doc("of a frontier: fewer points make no surface");
    s.param("deflation", &Params::deflation)
        .unit("1")
        .within(0.1, 5.0)
        .doc("standard deviations around the frontier within which points stay");
}

void MarginPoints::run(Run& run) {
    const Cloud& cloud = run.in<Cloud>("cloud");
    const double degree = M_PI / 180.0;
    double step = p_.margin_step_deg * degree;
    if (step == 0.0) {
        const double density = angular_density(*cloud.points);
        step = std::clamp(density > 0.0 ? std::sqrt(kPointsInCell / density) : 0.0,
                          0.5 * p_.beam_deg * degree, 1.5 * p_.beam_deg * degree);
    }
    const AngularCells cells(*cloud.points, step, run);
    const auto measured = range_noise(cells, run);
    const double noise = std::max(measured.value_or(kAssumedNoise), kLeastNoise);
    const double threshold = p_.range_threshold > 0.0 ? p_.range_threshold : kSigmas * noise;
    MarginSettings settings;
    settings.noise = static_cast<float>(noise);
    settings.threshold = static_cast<float>(threshold);
    settings.deflation = static_cast<float>(p_.deflation);
    settings.reach = p_.window;
    settings.min_points = p_.min_points;
    settings.edge_reach =
        static_cast<float>(std::sqrt(0.5) * cells.step() + p_.beam_deg * degree / 3.0);

    std::vector<std::uint8_t> marks(cloud.size());
    const MarginCounts counts = mark_margin_points(cells, settings, run, marks);
    std::vector<std::uint32_t> kept;
    for (std::size_t i = 0; i < marks.size(); ++i)
        if (marks[i] != 0) kept.push_back(static_cast<std::uint32_t>(i));

    const std::string told =
        printed("margin_step_deg %.3f, range_threshold %.3f m (noise of ranges %.1f mm%s)",
                step / degree, threshold, noise * 1e3, measured ? "" : ", assumed");
    run.log(LogLevel::info,
            told + printed("; %zu of %zu cells have margin points", counts.margin, counts.cells));
    Note none;
    none.looked_for = "cells with an edge in depth";
    none.threshold = told;
    none.hint = "a lower range_threshold, or a longer capture";
    const std::size_t finite =
        cells.points().size() == cloud.size() ? cloud.size() : finite_points(cloud).size();
    write_subset(run, cloud, kept, finite, none);
}

}  // namespace petal
