// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "petal/calibration/se3.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <unsupported/Eigen/MatrixFunctions>

namespace petal {
namespace {

Vector6d random_twist(std::mt19937_64& rng, double angle) {
    std::normal_distribution<double> normal;
    Vector6d twist;
    for (Eigen::Index i = 0; i < 6; ++i) twist[i] = normal(rng);
    twist.tail<3>() *= angle / twist.tail<3>().norm();
    return twist;
}

Eigen::Matrix4d hat(const Vector6d& twist) {
    Eigen::Matrix4d m = Eigen::Matrix4d::Zero();
    m.topLeftCorner<3, 3>() = skew(twist.tail<3>());
    m.topRightCorner<3, 1>() = twist.head<3>();
    return m;
}

const double kAngles[] = {0.0, 1e-12, 1e-8, 1e-4, 9.9e-4, 1.1e-3, 0.049, 0.051, 1.0, 2.5, 3.141};

TEST(Se3, SkewIsTheCrossProduct) {
    const Eigen::Vector3d v(1.0, -2.0, 3.0), w(0.3, 0.2, -0.7);
    EXPECT_LT((skew(v) * w - v.cross(w)).norm(), 1e-15);
}

TEST(Se3, ExpIsTheMatrixExponentialNotTheProductOfTheLetter) {
    std::mt19937_64 rng(1);
    for (const double angle : kAngles) {
        const Vector6d twist = random_twist(rng, angle);
        const Eigen::Matrix4d expected = hat(twist).exp();
        // 1e-13: some ten roundings on entries of size 1.
        EXPECT_LT((se3_exp(twist).matrix() - expected).norm(), 1e-13) << angle;
    }
}

TEST(Se3, LogInvertsExp) {
    std::mt19937_64 rng(2);
    for (const double angle : kAngles) {
        const Vector6d twist = random_twist(rng, angle);
        // Near pi the logarithm is a factor 10 less well conditioned than elsewhere.
        EXPECT_LT((se3_log(se3_exp(twist)) - twist).norm(), 1e-12) << angle;
        EXPECT_NEAR(rotation_angle(se3_exp(twist).linear()), angle, 1e-12);
    }
    EXPECT_NEAR(rotation_angle(Eigen::Vector3d(-1.0, -1.0, 1.0).asDiagonal()), 3.14159265358979,
                1e-12);
}

TEST(Se3, AdjointMovesATwistThroughATransform) {
    std::mt19937_64 rng(3);
    const Eigen::Isometry3d transform = se3_exp(random_twist(rng, 1.2));
    const Vector6d twist = random_twist(rng, 0.4);
    const Eigen::Isometry3d left = se3_exp(adjoint(transform) * twist);
    const Eigen::Isometry3d right = transform * se3_exp(twist) * transform.inverse();
    EXPECT_LT((left.matrix() - right.matrix()).norm(), 1e-13);
}

}  // namespace
}  // namespace petal
