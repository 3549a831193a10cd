// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "petal/calibration/se3.hpp"

#include <Eigen/LU>
#include <cmath>

namespace petal {
namespace {

// Below this angle the closed forms lose digits to cancellation; the series then err by theta^4 /
// 100, less than 1e-14.
constexpr double kSmallAngle = 1e-3;

/// (1 - cos a) / a^2
double cosine_factor(double a) {
    if (a < kSmallAngle) return 0.5 - a * a / 24.0;
    const double half = std::sin(0.5 * a) / a;
    return 2.0 * half * half;
}

/// (a - sin a) / a^3
double sine_factor(double a) {
    // The cancellation is worse here: the series is taken further, for longer.
    if (a < 0.05) {
        const double a2 = a * a;
        return 1.0 / 6.0 - a2 / 120.0 * (1.0 - a2 / 42.0 * (1.0 - a2 / 72.0));
    }
    return (a - std::sin(a)) / (a * a * a);
}

/// V of Exp: t = V rho.
Eigen::Matrix3d left_jacobian(const Eigen::Vector3d& phi) {
    const double angle = phi.norm();
    const Eigen::Matrix3d s = skew(phi);
    return Eigen::Matrix3d::Identity() + cosine_factor(angle) * s + sine_factor(angle) * s * s;
}

Eigen::Matrix3d so3_exp(const Eigen::Vector3d& phi) {
    const double angle = phi.norm();
    const Eigen::Vector3d axis =
        angle > 0.0 ? Eigen::Vector3d(phi / angle) : Eigen::Vector3d::UnitX();
    return Eigen::AngleAxisd(angle, axis).toRotationMatrix();
}

Eigen::Vector3d so3_log(const Eigen::Matrix3d& rotation) {
    // Through the quaternion: well conditioned at every angle, also near pi.
    Eigen::Quaterniond q(rotation);
    q.normalize();
    if (q.w() < 0.0) q.coeffs() = -q.coeffs();
    const double sine = q.vec().norm();
    if (sine < 1e-12) return 2.0 * q.vec();
    return 2.0 * std::atan2(sine, q.w()) / sine * q.vec();
}

}  // namespace

Eigen::Matrix3d skew(const Eigen::Vector3d& v) {
    Eigen::Matrix3d m;
    m << 0.0, -v.z(), v.y(), v.z(), 0.0, -v.x(), -v.y(), v.x(), 0.0;
    return m;
}

Eigen::Isometry3d se3_exp(const Vector6d& rho_phi) {
    const Eigen::Vector3d phi = rho_phi.tail<3>();
    Eigen::Isometry3d transform = Eigen::Isometry3d::Identity();
    transform.linear() = so3_exp(phi);
    transform.translation() = left_jacobian(phi) * rho_phi.head<3>();
    return transform;
}

Vector6d se3_log(const Eigen::Isometry3d& transform) {
    Vector6d rho_phi;
    const Eigen::Vector3d phi = so3_log(transform.linear());
    // det V = 2 (1 - cos a) / a^2: regular below 2 pi.
    rho_phi.head<3>() = left_jacobian(phi).inverse() * transform.translation();
    rho_phi.tail<3>() = phi;
    return rho_phi;
}

double rotation_angle(const Eigen::Matrix3d& rotation) {
    return so3_log(rotation).norm();
}

Matrix6d adjoint(const Eigen::Isometry3d& transform) {
    Matrix6d ad = Matrix6d::Zero();
    const Eigen::Matrix3d rotation = transform.linear();
    ad.topLeftCorner<3, 3>() = rotation;
    ad.topRightCorner<3, 3>() = skew(transform.translation()) * rotation;
    ad.bottomRightCorner<3, 3>() = rotation;
    return ad;
}

}  // namespace petal
