// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <string>

#include "petal/spec.hpp"
#include "solvers/detail/extrinsics_estimate.hpp"
#include "solvers/detail/verdict_declaration.hpp"

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
    declare_verdict(s);
    s.param("min_other_pose_ratio", &SolverParams::min_other_pose_ratio)
        .unit("1")
        .within(1.0, 100.0)
        .doc("weak where another pose fits the same pairs with less than this times the RMS");
}

}  // namespace petal
