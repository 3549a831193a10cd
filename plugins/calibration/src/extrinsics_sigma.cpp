// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "petal/calibration/extrinsics_sigma.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>

#include "petal/calibration/se3.hpp"

namespace petal {

Matrix6d column_covariance(const Matrix6d& covariance, const Eigen::Isometry3d& T_camera_lidar) {
    Matrix6d map = Matrix6d::Identity();
    map.topRightCorner<3, 3>() = -skew(T_camera_lidar.translation());
    return map * covariance * map.transpose();
}

Matrix6d column_covariance(const CameraExtrinsics& camera) {
    return column_covariance(camera.covariance, camera.T_camera_lidar);
}

PrincipalSigma principal_sigma(const CameraExtrinsics& camera) {
    return principal_sigma(column_covariance(camera));
}

PrincipalSigma principal_sigma(const Matrix6d& column) {
    if (!column.allFinite()) {  // NaN would count as no error at all
        const double unknown = std::numeric_limits<double>::infinity();
        return {unknown, unknown};
    }
    const auto largest = [](const Eigen::Matrix3d& block) {
        const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(block, Eigen::EigenvaluesOnly);
        return std::sqrt(std::max(0.0, eigen.eigenvalues()[2]));
    };
    return {largest(column.topLeftCorner<3, 3>()), largest(column.bottomRightCorner<3, 3>())};
}

}  // namespace petal
