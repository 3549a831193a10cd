// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "metrics/detail/truth_figures.hpp"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <cmath>
#include <limits>
#include <random>

#include "petal/calibration/se3.hpp"

namespace petal {
namespace {

/// The usual mounting: the LiDAR's x is the camera's z.
Eigen::Isometry3d mounting() {
    Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
    T.linear() << 0, -1, 0, 0, 0, -1, 1, 0, 0;
    T.translation() << 0.04, -0.1, 0.02;
    return T;
}

/// Sigmas of millimetres and hundredths of a degree, strongly tied to each other as those of one
/// board are.
Matrix6d tied_covariance() {
    std::mt19937_64 engine(5);
    std::normal_distribution<double> normal;
    Matrix6d mix;
    for (Eigen::Index i = 0; i < mix.size(); ++i) mix(i) = normal(engine);
    Vector6d sigma;
    sigma << 0.01, 0.005, 0.002, 0.001, 0.002, 0.0003;
    mix = sigma.asDiagonal() * mix;
    mix.col(0) *= 20.0;  // one direction is hardly known
    return mix * mix.transpose();
}

/// The mean NEES over errors drawn from a covariance, by a solver that claims `claimed`.
double mean_nees(const Matrix6d& drawn_from, const Matrix6d& claimed, int count) {
    const Matrix6d root = Eigen::LLT<Matrix6d>(drawn_from).matrixL();
    std::mt19937_64 engine(11);
    std::normal_distribution<double> normal;
    double sum = 0.0;
    for (int i = 0; i < count; ++i) {
        Vector6d unit;
        for (Eigen::Index k = 0; k < 6; ++k) unit[k] = normal(engine);
        // T_true = Exp(xi) T_est
        CameraExtrinsics estimate;
        estimate.T_camera_lidar = se3_exp(root * unit).inverse() * mounting();
        estimate.covariance = claimed;
        sum += pose_error(estimate, mounting()).nees.value();
    }
    return sum / count;
}

TEST(TruthFigures, NeesOfAnHonestCovarianceIsSix) {
    constexpr int kCount = 3000;
    // Chi-square with 6 degrees of freedom: mean 6, variance 12. Four standard errors.
    const double tolerance = 4.0 * std::sqrt(12.0 / kCount);
    const Matrix6d honest = tied_covariance();
    EXPECT_NEAR(mean_nees(honest, honest, kCount), 6.0, tolerance);
    // Sigmas half of what they are: four times as much.
    EXPECT_NEAR(mean_nees(honest, 0.25 * honest, kCount), 24.0, 4.0 * tolerance);
    // In the LiDAR's frame it is another covariance: the side of the perturbation matters.
    const Matrix6d ad = adjoint(mounting().inverse());
    EXPECT_GT(std::abs(mean_nees(honest, ad * honest * ad.transpose(), kCount) - 6.0),
              10.0 * tolerance);
}

TEST(TruthFigures, NeesByHand) {
    CameraExtrinsics estimate;
    estimate.T_camera_lidar = mounting();
    estimate.T_camera_lidar.translation().x() += 0.005;  // xi: -0.005 m along rho x, no other
    estimate.covariance =
        (Vector6d() << 1e-6, 4e-6, 9e-6, 1e-6, 1e-6, 1e-6).finished().asDiagonal();
    const PoseError error = pose_error(estimate, mounting());
    EXPECT_NEAR(error.nees.value(), 25.0, 1e-9);
    bool told = false;
    for (const Metric& one : truth_figures(error, {}, ""))
        told = told || (one.name == "truth.nees" && one.value == error.nees && one.unit == "1");
    EXPECT_TRUE(told);
}

TEST(TruthFigures, NoNeesWithoutAPositiveDefiniteCovariance) {
    CameraExtrinsics estimate;
    estimate.T_camera_lidar = mounting();
    // Far apart as numbers, since metres and radians are, yet honest.
    estimate.covariance =
        (Vector6d() << 1e-2, 1e-2, 1e-2, 1e-12, 1e-12, 1e-12).finished().asDiagonal();
    EXPECT_TRUE(pose_error(estimate, mounting()).nees);
    Matrix6d singular = Matrix6d::Identity();
    singular(0, 1) = singular(1, 0) = 1.0;
    Matrix6d indefinite = Matrix6d::Identity();
    indefinite(0, 1) = indefinite(1, 0) = 2.0;
    Matrix6d uneven = Matrix6d::Identity();
    uneven(0, 1) = 0.5;
    Matrix6d nan = Matrix6d::Identity();
    nan(2, 2) = std::numeric_limits<double>::quiet_NaN();
    const Matrix6d zero = Matrix6d::Zero();
    for (const Matrix6d& covariance : {zero, singular, indefinite, uneven, nan}) {
        estimate.covariance = covariance;
        EXPECT_FALSE(pose_error(estimate, mounting()).nees) << covariance;
    }
}

}  // namespace
}  // namespace petal
