// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include "petal/calibration/extrinsics.hpp"

namespace petal {

/// The principal 1-sigma of an estimate: of the fourth column of T (m), of the rotation (rad).
/// Infinite where the covariance holds NaN or infinity.
struct PrincipalSigma {
    double translation = 0.0;
    double rotation = 0.0;
};
PrincipalSigma principal_sigma(const CameraExtrinsics& camera);
/// The same from the covariance of (t, phi).
PrincipalSigma principal_sigma(const Matrix6d& column);

/// The covariance of (t, phi), t the fourth column of T: t' = t + phi x t + rho. From that of
/// (rho, phi).
Matrix6d column_covariance(const Matrix6d& covariance, const Eigen::Isometry3d& T_camera_lidar);
Matrix6d column_covariance(const CameraExtrinsics& camera);

}  // namespace petal
