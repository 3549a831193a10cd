// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "detectors/lidar_template.hpp"

namespace petal {

void LidarTemplate::describe(Spec<Params>& s) {
    s.summary("Finds boards anywhere in a cloud by fitting the target to all rays around plates.");
    s.doc(
        R"(Three steps; [lidar_template.md](../lidar_template.md) has the formulas and what they reach.

1. **Plates.** The points are gathered into cubic cells of a tenth of the board's lesser side. Around cells in a drawn order the plane with the most
   cells is found, and the middle of what lies in it moves to where the cells are. What fills about the target's area and has little in its plane around it is a plate. Planes,
   where they are wired, are tried first.
2. **Placement.** Every ray that crosses the plate's plane is a hit (it returned there) or a miss (from beyond). In all turns that look different, hits and misses
   are correlated with plate, holes and what is around the outline.
3. **Fit.** The probability of a hit is a logistic function of the distance to the template's edge. Place, turn, edge shifts along the
   beam's two axes, how they differ with the brightness behind the sides, the widths of the passage from hits to misses, and how much of the plate's thickness is seen in the holes, are estimated together; the plane is
   that of the plate's own points. Where nothing returns through a hole, the density of hits tells its edges. Of a target with holes only these are fitted: its rim may stand on the floor.

The covariance of the pose (left perturbation; rho in m, phi in rad) is marginal over all of these, and holds an error that the rays of each side share, from how the sides scatter. A range bias
that all points share is not in it.

**Points on edges alone** (`evidence` edges, or auto where no board is found among few points): the sides of the holes are fitted to the points near planes,
by least squares with Tukey's weights and the same two shifts.

A plate is no board where the template tells hits from misses badly (`min_gain`), its holes are closed, its surface goes on behind the outline, or its sides
stand otherwise than the target's; the last is a finding too, since the target file may be wrong.

Order: row by row from the top left for an observer at the sensor whose up is the LiDAR's +z (its +x where +z is along the normal).
The true upper side the LiDAR cannot tell: a square board looks alike in four orders.)");
    s.role("lidar_board_detector");
    s.reads<Cloud>("cloud",
                   "the scene's points in the LiDAR frame, all of them; or points on edges");
    s.reads<Planes>("planes", "plane patches to look at first").optional();
    s.writes<LidarBoards>("boards", "the boards, the likeliest plate first");
    s.param("target", &Params::target)
        .doc("the calibration board: a shipped name or the path of a target file");
    s.param("evidence", &Params::evidence)
        .choices({"auto", "rays", "edges"})
        .doc(
            "rays: hits and misses of a whole cloud; edges: points on edges alone; auto: rays, and "
            "edges where they show no board and the cloud is small");
    s.param("max_candidates", &Params::max_candidates)
        .within(1, 1000)
        .doc("the most plates that are looked at, the likeliest first");
    s.param("edge_shift_sigma_level", &Params::edge_shift_sigma_level)
        .unit("m")
        .within(0.0001, 0.1)
        .doc("1 sigma, beforehand, of the edges' shift along the beam's level axis");
    s.param("edge_shift_sigma_upright", &Params::edge_shift_sigma_upright)
        .unit("m")
        .within(0.0001, 0.1)
        .doc("the same along its upright axis");
    s.param("max_shift", &Params::max_shift)
        .unit("m")
        .within(0.0, 0.2)
        .doc("the most that the edges may be shifted");
    s.param("min_gain", &Params::min_gain)
        .unit("1")
        .within(0.0, 1.0)
        .doc(
            "how much better than the mere share of hits the template must tell hits from misses: "
            "1 - log L / log L_0");
    s.param("min_open", &Params::min_open)
        .unit("1")
        .within(0.0, 1.0)
        .doc("the share of rays that must pass the holes, off their edges");
    s.param("min_outline", &Params::min_outline)
        .unit("1")
        .within(0.0, 1.0)
        .doc("the share of the same beyond the outline: what stands free");
    s.param("max_flatness", &Params::max_flatness)
        .unit("m")
        .within(0.0, 0.1)
        .doc("the most by which parts of the plate may lie off its plane, RMS");
    s.param("max_stretch", &Params::max_stretch)
        .unit("1")
        .within(0.0, 1.0)
        .doc("the most that the sides may stand farther apart than the target's, relative");
    s.param("min_edge_coverage", &Params::min_edge_coverage)
        .unit("1")
        .within(0.0, 1.0)
        .doc("edges: the share of fifths of the holes' sides that must hold a point");
    s.param("max_inside", &Params::max_inside)
        .unit("1")
        .within(0.0, 1.0)
        .doc("edges: the most points well inside plate or holes, as a share of all there");
    s.param("max_edge_rms", &Params::max_edge_rms)
        .unit("m")
        .within(0.0001, 0.1)
        .doc("edges: the most RMS distance of the points from the sides");
    s.param("max_edge_points", &Params::max_edge_points)
        .at_least(1)
        .doc("auto: a cloud with more points is not one of edges alone");
}

}  // namespace petal
