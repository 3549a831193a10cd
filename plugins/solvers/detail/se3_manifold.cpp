// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "solvers/detail/se3_manifold.hpp"

#include <algorithm>

#include "petal/calibration/se3.hpp"

namespace petal {
namespace {

/// d(Exp(phi) q) / dphi at 0: 4 x 3, rows x y z w. Half the right-multiplication by q.
Eigen::Matrix<double, 4, 3> quaternion_by_phi(const Eigen::Quaterniond& q) {
    Eigen::Matrix<double, 4, 3> m;
    m.topRows<3>() = 0.5 * (q.w() * Eigen::Matrix3d::Identity() - skew(q.vec()));
    m.bottomRows<1>() = -0.5 * q.vec().transpose();
    return m;
}

}  // namespace

PoseBlock to_block(const Eigen::Isometry3d& pose) {
    const Eigen::Quaterniond q = Eigen::Quaterniond(pose.linear()).normalized();
    return {q.x(),
            q.y(),
            q.z(),
            q.w(),
            pose.translation().x(),
            pose.translation().y(),
            pose.translation().z()};
}

Eigen::Isometry3d to_pose(const double* block) {
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    pose.linear() =
        Eigen::Quaterniond(block[3], block[0], block[1], block[2]).normalized().toRotationMatrix();
    pose.translation() = Eigen::Vector3d(block[4], block[5], block[6]);
    return pose;
}

Eigen::Matrix<double, 6, 7> minus_jacobian(const double* block) {
    const Eigen::Quaterniond q(block[3], block[0], block[1], block[2]);
    const Eigen::Vector3d t(block[4], block[5], block[6]);
    // The columns of quaternion_by_phi are orthogonal, of length 1/2: 4 times the transpose inverts
    // it.
    const Eigen::Matrix<double, 3, 4> phi = 4.0 * quaternion_by_phi(q).transpose();
    Eigen::Matrix<double, 6, 7> m;
    m << skew(t) * phi, Eigen::Matrix3d::Identity(), phi, Eigen::Matrix3d::Zero();
    return m;
}

bool Se3Manifold::Plus(const double* x, const double* delta, double* x_plus_delta) const {
    const Vector6d twist = Eigen::Map<const Vector6d>(delta);
    const PoseBlock moved = to_block(se3_exp(twist) * to_pose(x));
    std::copy(moved.begin(), moved.end(), x_plus_delta);
    return true;
}

bool Se3Manifold::PlusJacobian(const double* x, double* jacobian) const {
    Eigen::Map<Eigen::Matrix<double, 7, 6, Eigen::RowMajor>> m(jacobian);
    const Eigen::Quaterniond q(x[3], x[0], x[1], x[2]);
    m.setZero();
    m.topRightCorner<4, 3>() = quaternion_by_phi(q);
    m.bottomLeftCorner<3, 3>().setIdentity();
    m.bottomRightCorner<3, 3>() = -skew(Eigen::Vector3d(x[4], x[5], x[6]));
    return true;
}

bool Se3Manifold::Minus(const double* y, const double* x, double* y_minus_x) const {
    Eigen::Map<Vector6d> twist(y_minus_x);
    twist = se3_log(to_pose(y) * to_pose(x).inverse());
    return true;
}

bool Se3Manifold::MinusJacobian(const double* x, double* jacobian) const {
    Eigen::Map<Eigen::Matrix<double, 6, 7, Eigen::RowMajor>> m(jacobian);
    m = minus_jacobian(x);
    return true;
}

}  // namespace petal
