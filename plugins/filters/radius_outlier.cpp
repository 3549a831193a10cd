// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "filters/radius_outlier.hpp"

#include "filters/detail/crowded_points.hpp"
#include "petal/printed.hpp"

namespace petal {

void RadiusOutlier::describe(Spec<Params>& s) {
    s.summary("Drops points that have too few neighbours inside a ball.");
    s.doc(
        R"(A point stays when at least `min_neighbours` other points lie nearer to it than `radius`. That takes lonely points: rain, dust,
and the thinnest of the vacant points. It knows nothing of beams, so the dense part of the curtain between a board and the wall behind
stays, and thin surfaces far away, where the points are few, go. A capture of 10 s or more is so dense that the defaults, which suit
a few sweeps or margin points, take next to nothing of it: 0.02 m and 6 take 6 % of the vacant points at 3 m.

The time grows linearly with the points, however dense the cloud is. filter.sparse_points counts in the same way, with the letter's
thresholds for margin points.)");
    s.role("outlier_remover");
    s.reads<Cloud>("cloud", "points in the LiDAR frame");
    s.writes<Cloud>("cloud", "the points that stay, in their order");
    s.param("radius", &Params::radius).unit("m").within(0.001, 10.0).doc("ball radius");
    s.param("min_neighbours", &Params::min_neighbours)
        .within(1, 1000)
        .doc("a point with fewer others in its ball goes");
}

void RadiusOutlier::run(Run& run) {
    write_crowded_points(
        run, params_.radius, params_.min_neighbours,
        printed("min_neighbours %d within radius %g m", params_.min_neighbours, params_.radius),
        "enlarge the radius, or give more seconds of data");
}

}  // namespace petal
