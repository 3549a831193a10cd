// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "filters/none.hpp"

#include "petal/calibration/cloud.hpp"

namespace petal {

void NoFilter::describe(Spec<Params>& s) {
    s.summary("Passes the cloud on as it is, to see what another filter is worth.");
    s.doc(
        R"(Any other outlier remover takes its place: `{"stages": {"margins": {"type": "filter.none"}}}`, given with
`--with`, shows what a pipeline does without one. Nothing is copied or dropped, not even points that are not finite.)");
    s.role("outlier_remover");
    s.reads<Cloud>("cloud", "points in the LiDAR frame");
    s.writes<Cloud>("cloud", "the very same");
}

void NoFilter::run(Run& run) {
    run.forward("cloud", run.in_ptr<Cloud>("cloud"));
}

}  // namespace petal
