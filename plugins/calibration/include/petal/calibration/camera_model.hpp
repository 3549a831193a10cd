// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <mrpt/img/TCamera.h>

#include <Eigen/Core>
#include <optional>
#include <string>

namespace petal {

/// Projection with distortion, and its inverse, for MRPT's three models: none, plumb bob (k1 k2 p1
/// p2 k3 and the rational k4 k5 k6) and Kannala-Brandt (k1 to k4). Raw pixels; the centre of the
/// top-left pixel is (0, 0). Immutable: safe to share between threads.
class CameraModel {
   public:
    /// \throws Error when the intrinsics are no camera: focal length not positive, no size, NaN.
    explicit CameraModel(const mrpt::img::TCamera& camera);

    /// pi(p) of equation (10), with distortion. None where p is not in front of the camera, or lies
    /// beyond the angle up to which the distortion is monotonic.
    /// `jacobian`, where given, is d(u, v) / d(x, y, z): equation (14), with distortion.
    std::optional<Eigen::Vector2d> project(const Eigen::Vector3d& p_camera,
                                           Eigen::Matrix<double, 2, 3>* jacobian = nullptr) const;

    /// The direction (x, y, 1) that projects to a raw pixel. None where the inverse does not
    /// converge.
    std::optional<Eigen::Vector3d> unproject(const Eigen::Vector2d& pixel) const;

    /// Ideal pinhole pixel of a raw pixel and back, with the same K: K * unproject(pixel).
    std::optional<Eigen::Vector2d> undistort(const Eigen::Vector2d& pixel) const;
    std::optional<Eigen::Vector2d> distort(const Eigen::Vector2d& ideal_pixel) const;

    const mrpt::img::TCamera& camera() const { return camera_; }
    double fx() const { return fx_; }
    double fy() const { return fy_; }
    double cx() const { return cx_; }
    double cy() const { return cy_; }

   private:
    mrpt::img::TCamera camera_;
    double fx_, fy_, cx_, cy_;
    double max_theta_;  ///< rad: the largest angle off the axis at which the model can be trusted
};

}  // namespace petal
