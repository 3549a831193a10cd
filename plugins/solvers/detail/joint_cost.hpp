// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <ceres/cost_function.h>
#include <ceres/sized_cost_function.h>

#include <cmath>

#include "solvers/detail/joint_model.hpp"

namespace petal {

/// Ceres costs over what joint_model.hpp linearises. Poses are blocks on Se3Manifold; what a cost
/// refers to must outlive it. `weight` is that of the squared error.

/// A board's pose against the LiDAR's measurement; parameters: T_lidar_board, range offset.
class BoardPoseCost final : public ceres::SizedCostFunction<6, 7, 1> {
   public:
    BoardPoseCost(const JointBoard& board, double weight)
        : board_(board), root_(std::sqrt(weight)) {}
    bool Evaluate(double const* const* parameters, double* residuals,
                  double** jacobians) const override;

   private:
    const JointBoard& board_;
    double root_;
};

/// A board's corners in one image; parameters: T_camera_lidar, T_lidar_board, focal factor.
class BoardViewCost final : public ceres::CostFunction {
   public:
    BoardViewCost(const CameraModel& model, const JointBoard::View& view, double weight);
    bool Evaluate(double const* const* parameters, double* residuals,
                  double** jacobians) const override;

   private:
    const CameraModel& model_;
    const JointBoard::View& view_;
    double root_;
};

/// A single point; parameters: T_camera_lidar, focal factor, range offset. Its noise is that at the
/// start.
class JointPointCost final : public ceres::SizedCostFunction<2, 7, 1, 1> {
   public:
    JointPointCost(const CameraModel& model, const JointPoint& point,
                   const Eigen::Matrix2d& whitening, double weight)
        : model_(model), point_(point), whitening_(whitening), root_(std::sqrt(weight)) {}
    bool Evaluate(double const* const* parameters, double* residuals,
                  double** jacobians) const override;

   private:
    const CameraModel& model_;
    const JointPoint& point_;
    Eigen::Matrix2d whitening_;
    double root_;
};

/// A number that is zero but for `sigma`.
class ZeroPriorCost final : public ceres::SizedCostFunction<1, 1> {
   public:
    explicit ZeroPriorCost(double sigma) : sigma_(sigma) {}
    bool Evaluate(double const* const* parameters, double* residuals,
                  double** jacobians) const override;

   private:
    double sigma_;
};

/// A prior on the fourth column of T_camera_lidar.
class TranslationPriorCost final : public ceres::SizedCostFunction<3, 7> {
   public:
    TranslationPriorCost(const Eigen::Vector3d& translation, double sigma)
        : translation_(translation), sigma_(sigma) {}
    bool Evaluate(double const* const* parameters, double* residuals,
                  double** jacobians) const override;

   private:
    Eigen::Vector3d translation_;
    double sigma_;
};

}  // namespace petal
