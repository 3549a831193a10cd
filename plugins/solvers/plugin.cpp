// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "petal/plugin.hpp"

#include "petal/calibration/camera_model.hpp"
#include "solvers/board_matcher.hpp"
#include "solvers/joint.hpp"
#include "solvers/pnp.hpp"
#include "solvers/reprojection.hpp"

PETAL_PLUGIN("solvers", "0.1.0", [](petal::Registrar& r) {
    r.add<petal::BoardMatcher>("solver.board_matcher");
    r.add<petal::Joint>("solver.joint");
    r.add<petal::Reprojection>("solver.reprojection");
    r.add<petal::Pnp>("solver.pnp");
});
