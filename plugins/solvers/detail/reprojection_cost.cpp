// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "solvers/detail/reprojection_cost.hpp"

#include "solvers/detail/se3_manifold.hpp"

namespace petal {

Eigen::Matrix<double, 2, 6> projection_jacobian(const Eigen::Matrix<double, 2, 3>& by_point,
                                                const Eigen::Vector3d& p_camera) {
    Eigen::Matrix<double, 2, 6> jacobian;
    jacobian << by_point, -by_point * skew(p_camera);
    return jacobian;
}

ReprojectionCost::ReprojectionCost(const CameraModel& model, const Eigen::Vector3d& p_lidar,
                                   const Eigen::Vector2d& measured,
                                   const Eigen::Matrix2d& sqrt_weight)
    : model_(model), p_lidar_(p_lidar), measured_(measured), sqrt_weight_(sqrt_weight) {}

bool ReprojectionCost::Evaluate(double const* const* parameters, double* residuals,
                                double** jacobians) const {
    const Eigen::Vector3d p_camera = to_pose(parameters[0]) * p_lidar_;
    Eigen::Matrix<double, 2, 3> by_point;
    const auto pixel = model_.project(p_camera, &by_point);
    if (!pixel) return false;
    Eigen::Map<Eigen::Vector2d> error(residuals);
    error = sqrt_weight_ * (measured_ - *pixel);
    if (jacobians != nullptr && jacobians[0] != nullptr) {
        Eigen::Map<Eigen::Matrix<double, 2, 7, Eigen::RowMajor>> jacobian(jacobians[0]);
        // Ceres multiplies by the manifold's PlusJacobian, which gives back the 2 x 6 one.
        jacobian =
            -sqrt_weight_ * projection_jacobian(by_point, p_camera) * minus_jacobian(parameters[0]);
    }
    return true;
}

}  // namespace petal
