// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <ceres/sized_cost_function.h>

#include <Eigen/Core>

#include "petal/calibration/camera_model.hpp"
#include "petal/calibration/se3.hpp"

namespace petal {

/// d(pi(T p)) / d(rho, phi): (14) with distortion, times [I | -[T p]_x] of (15). 2 x 6, px per m
/// and rad.
Eigen::Matrix<double, 2, 6> projection_jacobian(const Eigen::Matrix<double, 2, 3>& by_point,
                                                const Eigen::Vector3d& p_camera);

/// e = S (measured - pi(T p)) of equation (10), S a square root of the pair's weight, on a pose
/// block. Its derivative is -S (14)(15): the letter's (14) lacks the minus.
class ReprojectionCost final : public ceres::SizedCostFunction<2, 7> {
   public:
    /// `model` must outlive the cost.
    ReprojectionCost(const CameraModel& model, const Eigen::Vector3d& p_lidar,
                     const Eigen::Vector2d& measured, const Eigen::Matrix2d& sqrt_weight);
    /// False where the point does not project: Ceres then rejects the step.
    bool Evaluate(double const* const* parameters, double* residuals,
                  double** jacobians) const override;

   private:
    const CameraModel& model_;
    Eigen::Vector3d p_lidar_;
    Eigen::Vector2d measured_;
    Eigen::Matrix2d sqrt_weight_;
};

}  // namespace petal
