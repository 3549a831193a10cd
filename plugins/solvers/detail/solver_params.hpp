// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <string>

#include "petal/spec.hpp"
#include "solvers/detail/extrinsics_estimate.hpp"
#include "solvers/detail/verdict.hpp"

namespace petal {

/// What every stage of the role `solver` has in common.
struct SolverParams : UncertaintyParams, VerdictParams {
    bool use_distortion = true;
    std::string weighting = "covariance";
    double min_other_pose_ratio = 1.5;
};

/// Declares the ports, the role and the parameters of SolverParams.
template <class Params>
void describe_solver(Spec<Params>& s) {
    s.role("solver");
    s.template gathers<Correspondences>("correspondences",
                                        "pairs of every scene; scenes are taken by frame number");
    s.template writes<Extrinsics>("extrinsics",
                                  "T_camera_lidar of each camera, covariance, residuals, verdict");
    s.param("use_distortion", &SolverParams::use_distortion)
        .doc(
            "project with the camera's distortion; off where the pixels are rectified (the "
            "letter)");
    s.param("weighting", &SolverParams::weighting)
        .choices({"covariance", "none"})
        .doc("weigh the pairs by their image covariances, or all alike; the same for equal ones");
    s.param("board_redundancy", &SolverParams::board_redundancy)
        .unit("1")
        .within(1.0, 16.0)
        .doc(
            "how many times fewer independent numbers a board's corners hold than they count: the "
            "32 "
            "of 16 corners come from about 8 lines");
    s.param("min_sigma_px", &SolverParams::min_sigma_px)
        .unit("px")
        .within(0.0, 10.0)
        .doc("the standard deviation of unit weight s0 is not taken below it for the covariance");
    s.param("sigma_px", &SolverParams::sigma_px)
        .unit("px")
        .within(0.001, 100.0)
        .doc("what a covariance of 1 px^2 stands for in chi-square, as a standard deviation");
    s.param("usable_sigma", &SolverParams::usable_sigma)
        .unit("m")
        .within(0.0, 10.0)
        .doc("usable up to this largest principal 1-sigma of the translation");
    s.param("usable_sigma_deg", &SolverParams::usable_sigma_deg)
        .unit("deg")
        .within(0.0, 180.0)
        .doc("usable up to this largest principal 1-sigma of the rotation");
    s.param("not_usable_sigma", &SolverParams::not_usable_sigma)
        .unit("m")
        .within(0.0, 1000.0)
        .doc("not usable above this largest principal 1-sigma of the translation");
    s.param("not_usable_sigma_deg", &SolverParams::not_usable_sigma_deg)
        .unit("deg")
        .within(0.0, 180.0)
        .doc("not usable above this largest principal 1-sigma of the rotation");
    s.param("chi2_two_sided", &SolverParams::chi2_two_sided)
        .doc("a chi-square below its 99.9 % band makes the result weak too, not only one above");
    s.param("min_other_pose_ratio", &SolverParams::min_other_pose_ratio)
        .unit("1")
        .within(1.0, 100.0)
        .doc("weak where another pose fits the same pairs with less than this times the RMS");
    s.check([](const Params& p) {
        return p.usable_sigma <= p.not_usable_sigma && p.usable_sigma_deg <= p.not_usable_sigma_deg
                   ? std::string()
                   : "usable_sigma and usable_sigma_deg must not exceed not_usable_sigma and "
                     "not_usable_sigma_deg";
    });
}

}  // namespace petal
