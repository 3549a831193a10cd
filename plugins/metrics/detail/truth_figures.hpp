// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "petal/calibration/camera_model.hpp"
#include "petal/calibration/extrinsics.hpp"
#include "petal/calibration/metrics.hpp"
#include "petal/calibration/truth.hpp"

namespace petal {

/// How far an estimated T_camera_lidar is from the true one.
struct PoseError {
    Eigen::Vector3d rotation = Eigen::Vector3d::Zero();     ///< rad: R_est R_true^T, camera's axes
    Eigen::Vector3d translation = Eigen::Vector3d::Zero();  ///< m: t_est - t_true, camera's axes
    /// xi^T C^-1 xi with T_true = Exp(xi) T_est; none where C is not positive definite.
    std::optional<double> nees;
};

PoseError pose_error(const CameraExtrinsics& estimated, const Eigen::Isometry3d& truth);

/// How far the true corners of some boards move in the image.
struct CornerDrift {
    std::vector<double> px;  ///< |pi(T_est p) - pi(T_true p)| of each corner
    std::size_t lost = 0;    ///< corners that do not project under one of the poses

    void add(const CornerDrift& other);
};

CornerDrift corner_drift(const CameraModel& model, const Eigen::Isometry3d& estimated,
                         const Eigen::Isometry3d& truth, const std::vector<Truth::Board>& boards);

/// The figures of `metric.truth`, for one scene or (empty name) in total.
std::vector<Metric> truth_figures(const PoseError& pose, const CornerDrift& drift,
                                  const std::string& scene);

}  // namespace petal
