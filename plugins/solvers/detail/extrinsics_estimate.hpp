// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <string>

#include "petal/calibration/extrinsics.hpp"
#include "petal/calibration/extrinsics_sigma.hpp"
#include "solvers/detail/reprojection_problem.hpp"
#include "solvers/detail/solve_input.hpp"

namespace petal {

/// How the uncertainty of a pose is reckoned.
struct UncertaintyParams {
    /// How many times fewer independent numbers a board's corners hold than they count.
    double board_redundancy = 4.0;
    double min_sigma_px = 0.3;  ///< s0 is never taken below
    double sigma_px = 1.0;      ///< what covariance 1 of a pair stands for, for chi-square
};

/// The pose of one camera with its covariance, residuals and figures. Corners of boards count 1 /
/// board_redundancy each in J'WJ, in chi-square and in the degrees of freedom.
/// \throws Error where a pair does not project at `pose`.
CameraExtrinsics estimate(const SolveInput& input, const ReprojectionProblem& problem,
                          const Eigen::Isometry3d& pose, const UncertaintyParams& params);

/// The largest principal direction of `covariance` of (t, phi) in words, 1 m weighing as
/// `rotation_per_m` rad: "tilting about the camera's x axis (5.9 deg) together with a shift along
/// its y axis (0.48 m)".
std::string describe_weakest(const Matrix6d& covariance, double rotation_per_m);

}  // namespace petal
