// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <functional>
#include <vector>

#include "petal/run.hpp"
#include "solvers/detail/reprojection_problem.hpp"
#include "solvers/detail/solver_params.hpp"

namespace petal {

/// Poses that explain one camera's pairs, the best first; empty where there is none.
using PoseSearch = std::function<std::vector<RefinedPose>(const SolveInput& input,
                                                          const ReprojectionProblem& problem)>;

/// finish() of a solver: gathers, searches a pose for each camera, writes the extrinsics with their
/// uncertainty and tells the verdict. Cameras with fewer than four pairs, or without a pose, get a
/// note.
void run_solver(Run& run, const SolverParams& params, const RobustLoss& loss,
                const PoseSearch& search);

}  // namespace petal
