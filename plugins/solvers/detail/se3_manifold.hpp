// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <ceres/manifold.h>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>

namespace petal {

/// A pose as Ceres stores it: the unit quaternion x y z w, then the translation in metres.
using PoseBlock = std::array<double, 7>;
PoseBlock to_block(const Eigen::Isometry3d& pose);
Eigen::Isometry3d to_pose(const double* block);

/// SE(3) with the left perturbation of equation (12): Plus(T, (rho, phi)) = Exp((rho, phi)) T, with
/// the exponential of SE(3), not the letter's (11), which does not go with (15).
class Se3Manifold final : public ceres::Manifold {
   public:
    int AmbientSize() const override { return 7; }
    int TangentSize() const override { return 6; }
    bool Plus(const double* x, const double* delta, double* x_plus_delta) const override;
    bool PlusJacobian(const double* x, double* jacobian) const override;
    bool Minus(const double* y, const double* x, double* y_minus_x) const override;
    bool MinusJacobian(const double* x, double* jacobian) const override;
};

/// d Minus(y, x) / dy at y = x: 6 x 7. Turns a derivative by (rho, phi) into one by a pose block.
Eigen::Matrix<double, 6, 7> minus_jacobian(const double* block);

}  // namespace petal
