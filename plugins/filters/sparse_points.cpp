// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "filters/sparse_points.hpp"

#include "filters/detail/crowded_points.hpp"
#include "petal/printed.hpp"

namespace petal {

void SparsePoints::describe(Spec<Params>& s) {
    s.summary("Drops margin points that have few others near them: the letter's descriptor N.");
    s.doc(
        R"(The optional filter at the end of section III.B.1 of the letter: the descriptor N of a margin point is the
number of other points nearer to it than a distance, and a point with N below a threshold is eliminated. The
letter writes one symbol, delta_N, for the distance and for the threshold, and gives no values; here they are
`distance` and `min_neighbours`. "Nearer" is meant strictly, and a point does not count itself.

The defaults suit margin points of a Mid-70: on a board's edge at 8 m, after 20 s, about 40 others lie within 3 cm; a
stray echo in the vacant space has none. After less than 5 s at 8 m lower `min_neighbours`.

The points are sorted into cells of distance / sqrt(3), so the time grows linearly with the points: see
`filter.radius_outlier`, which is the same for whole clouds.)");
    s.role("outlier_remover");
    s.reads<Cloud>("cloud", "margin points in the LiDAR frame");
    s.writes<Cloud>("cloud", "the points that stay, in their order");
    s.param("distance", &Params::distance)
        .unit("m")
        .within(0.001, 10.0)
        .doc("delta_N as a distance: points nearer than this are counted");
    s.param("min_neighbours", &Params::min_neighbours)
        .within(1, 1000)
        .doc("delta_N as a threshold: a point with a lower N goes");
}

void SparsePoints::run(Run& run) {
    write_crowded_points(
        run, params_.distance, params_.min_neighbours,
        printed("min_neighbours %d, distance %g m", params_.min_neighbours, params_.distance),
        "enlarge the distance, or give more seconds of data");
}

}  // namespace petal
