// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "solvers/pnp.hpp"

#include <algorithm>

#include "solvers/detail/pose_starts.hpp"
#include "solvers/detail/solver_run.hpp"

namespace petal {

void Pnp::describe(Spec<Params>& s) {
    s.summary("The pose by one of OpenCV's perspective-n-point solvers.");
    s.doc(
        R"(Undistorts the pixels (pairs whose pixel lies outside the camera's model are left out) and hands
them with the LiDAR points to OpenCV, without an initial guess. The methods are deterministic; RANSAC is
not offered, since it draws from a generator of OpenCV's own.

| method | what |
|---|---|
| sqpnp | Terzakis and Lourakis 2020: the global minimum of the object-space error; the default |
| epnp | Lepetit et al. 2009: algebraic; coarse with few or nearly planar points |
| iterative | OpenCV's Levenberg-Marquardt from a DLT (six pairs at least) or a homography (planar pairs) |
| ippe | Collins and Bartoli 2014: both minima of a **planar** set; nothing where the pairs are not planar |

Of several poses the one with the least reprojection error is taken. All pairs weigh alike for OpenCV;
`weighting` and the other parameters act on covariance, chi-square and verdict alone, which are reckoned as
solver.reprojection does it, at OpenCV's pose. Only `iterative` minimises the reprojection error, and that
in undistorted coordinates; with the others the RMS is larger and s0 with it.)");
    describe_solver(s);
    s.param("method", &Params::method)
        .choices({"sqpnp", "epnp", "iterative", "ippe"})
        .doc("OpenCV's solver; ippe for pairs in one plane only");
}

void Pnp::finish(Run& run) {
    run_solver(run, p_, RobustLoss{}, [&](const SolveInput&, const ReprojectionProblem& problem) {
        std::vector<RefinedPose> poses;
        for (const auto& pose : pnp_poses(p_.method, problem.model(), problem.pairs()))
            if (const auto figures = problem.evaluate(pose)) poses.push_back(*figures);
        std::stable_sort(
            poses.begin(), poses.end(),
            [](const RefinedPose& a, const RefinedPose& b) { return a.cost < b.cost; });
        return poses;
    });
}

}  // namespace petal
