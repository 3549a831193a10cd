// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "solvers/reprojection.hpp"

#include "solvers/detail/pose_starts.hpp"
#include "solvers/detail/solver_run.hpp"

namespace petal {

void Reprojection::describe(Spec<Params>& s) {
    s.summary("The pose that minimises the reprojection error of all pairs (the letter's solver).");
    s.doc(R"(Solves equation (10) for each camera alone, over the pairs of all scenes:

    T = argmin 1/2 sum_i rho(|| S_i (u_i - pi(T p_i)) ||^2),    p_camera = T p_lidar

by Ceres (Levenberg-Marquardt) on SE(3). The derivative is petal's own: -S_i times (14), the derivative of
the projection **with** distortion, times (15), `[I | -[T p]_x]`. Where the letter errs: (13) writes P^L for
P^C; (14) lacks the minus of e = u - pi(T p); (11) is SO(3) x R^3, while (15) is the left perturbation of
SE(3), so the exponential of SE(3) is used. A test holds the derivative against automatic differentiation.

**Starts.** No initial guess is needed: the poses that the matcher found, both planar minima (IPPE) of every
board and of the whole, SQPNP and EPnP. Each is refined and the lowest cost is taken. Another minimum whose
RMS is less than `min_other_pose_ratio` times the best one's makes the result weak.

**Weights.** With `weighting` = covariance, S'S is the inverse of a pair's image covariance, scaled to a mean
of 1, so residuals stay pixels; equal covariances are plain least squares, the letter's case. `robust_loss`
is none by default: with a few hundred corners of detected boards a loss hides a wrong board, which the
residuals should show.

**Covariance** of (rho, phi) in T = Exp((rho, phi)) T_estimated: s0^2 (sum w_i J_i'W_i J_i)^-1. The corners of a
board are intersections of about 8 lines, so its 32 numbers count as 8: w_i = 1 / `board_redundancy` for
corners of boards, 1 for single points (for boards alone: 4 s0^2 (J'WJ)^-1). s0^2 is the median of the
weighted squared 2-D residuals over 2 ln 2, times 2N / (2N - 6): for Gaussian noise what the mean gives, but
one wrong corner does not inflate it (among the 32 published board corners outdoors one is wrong by 6 px).
s0 >= `min_sigma_px`: few residuals can be small by chance. Directions that nothing observes get 1000 m or
rad instead of infinity.

**Chi-square** is sum w_i r_i' C_i^-1 r_i / `sigma_px`^2 with 2 sum w_i - 6 degrees of freedom, C_i the pair's
covariance as it came; published pairs carry the identity, which means 1 px. Its 99.9 % point is Wilson and
Hilferty's. A chi-square that is too small says that the covariances are pessimistic, not that the pose is
wrong: it counts only with `chi2_two_sided`.

**Verdict.** usable: largest principal 1-sigma (of the fourth column of T, and of the rotation) within
`usable_sigma` and `usable_sigma_deg`, order decided by the data or given, chi-square in its band. not_usable:
nothing to solve, order undecided, or a sigma above `not_usable_sigma` or `not_usable_sigma_deg`. Else weak. A
small residual is no proof: two boards side by side fit better than a whole scene and leave 6 deg free.

**Limits.** The intrinsics are taken as exact. The covariance knows noise only, not boards that bend or
edges that move outdoors.)");
    describe_solver(s);
    s.param("robust_loss", &Params::robust_loss)
        .choices({"none", "huber", "cauchy"})
        .doc("loss on the weighted residual of each pair");
    s.param("loss_scale_px", &Params::loss_scale_px)
        .unit("px")
        .within(0.01, 1000.0)
        .doc("residual from which the loss weighs less; without effect where it is none");
}

void Reprojection::finish(Run& run) {
    const RobustLoss loss{RobustLoss::kind_of(p_.robust_loss), p_.loss_scale_px};
    run_solver(run, p_, loss, [](const SolveInput& input, const ReprojectionProblem& problem) {
        auto starts = input.initial;
        const auto found = pose_starts(problem.model(), problem.pairs());
        starts.insert(starts.end(), found.begin(), found.end());
        return problem.refine_all(starts);
    });
}

}  // namespace petal
