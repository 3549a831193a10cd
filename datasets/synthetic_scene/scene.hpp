// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <mrpt/img/TCamera.h>

#include <Eigen/Geometry>
#include <vector>

#include "petal/calibration/target.hpp"

namespace petal::synthetic {

/// What is where in the synthetic scene: the truth.
struct Scene {
    Target target;
    mrpt::img::TCamera camera;
    Eigen::Isometry3d T_camera_lidar = Eigen::Isometry3d::Identity();
    std::vector<Eigen::Isometry3d> T_lidar_board;
};

/// Four boards at 2.2 to 3.6 m, spread over the image and tilted; a camera of 960 x 720 with a
/// little distortion; a LiDAR (x forward, y left, z up) 5 cm right, 12 cm above and 7 cm in front
/// of it.
Scene make_scene();

}  // namespace petal::synthetic
