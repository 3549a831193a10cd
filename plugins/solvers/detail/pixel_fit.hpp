// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <vector>

#include "petal/calibration/boards.hpp"
#include "petal/calibration/camera_model.hpp"
#include "petal/calibration/correspondences.hpp"
#include "solvers/detail/reprojection_problem.hpp"

namespace petal {

/// A pose that plain least squares led to.
struct PixelFit {
    RefinedPose pose;
    Matrix6d information = Matrix6d::Zero();  ///< J'J of (rho, phi), for 1 px of noise a coordinate
};

/// Plain least squares over pixels from `start`: what ReprojectionProblem::refine gives without
/// weights and loss, by damped Gauss-Newton steps of its own, some ten times as fast: a search over
/// orders refines hundreds of poses. None where a pair does not project at the start.
std::optional<PixelFit> fit_pixels(const CameraModel& model, const std::vector<PointPair>& pairs,
                                   const Eigen::Isometry3d& start);

}  // namespace petal
