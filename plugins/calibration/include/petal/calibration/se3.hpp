// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "petal/calibration/boards.hpp"

namespace petal {

using Vector6d = Eigen::Matrix<double, 6, 1>;

/// [v]_x, the matrix with [v]_x w = v x w.
Eigen::Matrix3d skew(const Eigen::Vector3d& v);

/// The exponential of SE(3) for (rho, phi), m and rad. The letter's (11) is SO(3) x R^3, which
/// leaves out the left Jacobian; (15) is the left perturbation of SE(3), which is what this goes
/// with.
Eigen::Isometry3d se3_exp(const Vector6d& rho_phi);
/// Its inverse, for rotations below pi.
Vector6d se3_log(const Eigen::Isometry3d& transform);

/// The angle of a rotation, rad, in [0, pi].
double rotation_angle(const Eigen::Matrix3d& rotation);

/// The adjoint for the order (rho, phi): Exp(Ad(T) xi) = T Exp(xi) T^-1.
Matrix6d adjoint(const Eigen::Isometry3d& transform);

}  // namespace petal
