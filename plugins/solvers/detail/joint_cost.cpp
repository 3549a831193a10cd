// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "solvers/detail/joint_cost.hpp"

#include <Eigen/LU>

#include "solvers/detail/se3_manifold.hpp"

namespace petal {
namespace {

template <int Columns>
using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Columns, Eigen::RowMajor>;

/// A derivative by (rho, phi) as Ceres wants it, by the seven numbers of a pose block: its
/// PlusJacobian gives the former back.
template <class Derived>
void store_pose_jacobian(const Eigen::MatrixBase<Derived>& by_twist, const double* block,
                         double* out) {
    Eigen::Map<RowMajor<7>>(out, by_twist.rows(), 7) = by_twist * minus_jacobian(block);
}

}  // namespace

bool BoardPoseCost::Evaluate(double const* const* parameters, double* residuals,
                             double** jacobians) const {
    const BoardLinear linear = linearise(board_, to_pose(parameters[0]), parameters[1][0]);
    Eigen::Map<Vector6d> error(residuals);
    error = root_ * linear.error;
    if (jacobians == nullptr) return true;
    if (jacobians[0] != nullptr)
        store_pose_jacobian(root_ * linear.by_board, parameters[0], jacobians[0]);
    if (jacobians[1] != nullptr) {
        Eigen::Map<Vector6d> by_range(jacobians[1]);
        by_range = root_ * linear.by_range;
    }
    return true;
}

BoardViewCost::BoardViewCost(const CameraModel& model, const JointBoard::View& view, double weight)
    : model_(model), view_(view), root_(std::sqrt(weight)) {
    set_num_residuals(static_cast<int>(view.whitening.rows()));
    *mutable_parameter_block_sizes() = {7, 7, 1};
}

bool BoardViewCost::Evaluate(double const* const* parameters, double* residuals,
                             double** jacobians) const {
    ViewLinear linear;
    if (!linearise(model_, view_, to_pose(parameters[0]), to_pose(parameters[1]), parameters[2][0],
                   linear))
        return false;
    Eigen::Map<Eigen::VectorXd>(residuals, linear.error.size()) = root_ * linear.error;
    if (jacobians == nullptr) return true;
    if (jacobians[0] != nullptr)
        store_pose_jacobian(root_ * linear.by_camera, parameters[0], jacobians[0]);
    if (jacobians[1] != nullptr)
        store_pose_jacobian(root_ * linear.by_board, parameters[1], jacobians[1]);
    if (jacobians[2] != nullptr)
        Eigen::Map<Eigen::VectorXd>(jacobians[2], linear.error.size()) = root_ * linear.by_focal;
    return true;
}

bool JointPointCost::Evaluate(double const* const* parameters, double* residuals,
                              double** jacobians) const {
    PointLinear linear;
    if (!linearise(model_, point_, 0.0, to_pose(parameters[0]), parameters[1][0], parameters[2][0],
                   linear, &whitening_))
        return false;
    Eigen::Map<Eigen::Vector2d> error(residuals);
    error = root_ * linear.error;
    if (jacobians == nullptr) return true;
    if (jacobians[0] != nullptr)
        store_pose_jacobian(root_ * linear.by_camera, parameters[0], jacobians[0]);
    if (jacobians[1] != nullptr) {
        Eigen::Map<Eigen::Vector2d> by_focal(jacobians[1]);
        by_focal = root_ * linear.by_focal;
    }
    if (jacobians[2] != nullptr) {
        Eigen::Map<Eigen::Vector2d> by_range(jacobians[2]);
        by_range = root_ * linear.by_range;
    }
    return true;
}

bool ZeroPriorCost::Evaluate(double const* const* parameters, double* residuals,
                             double** jacobians) const {
    residuals[0] = parameters[0][0] / sigma_;
    if (jacobians != nullptr && jacobians[0] != nullptr) jacobians[0][0] = 1.0 / sigma_;
    return true;
}

bool TranslationPriorCost::Evaluate(double const* const* parameters, double* residuals,
                                    double** jacobians) const {
    const Eigen::Vector3d translation = to_pose(parameters[0]).translation();
    Eigen::Map<Eigen::Vector3d> error(residuals);
    error = (translation - translation_) / sigma_;
    if (jacobians != nullptr && jacobians[0] != nullptr) {
        Eigen::Matrix<double, 3, 6> by_twist;
        by_twist << Eigen::Matrix3d::Identity(), -skew(translation);
        store_pose_jacobian(by_twist / sigma_, parameters[0], jacobians[0]);
    }
    return true;
}

}  // namespace petal
