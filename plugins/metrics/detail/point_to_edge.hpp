// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "metrics/detail/pose_agreement.hpp"
#include "petal/calibration/boards.hpp"
#include "petal/calibration/camera_model.hpp"
#include "petal/calibration/cloud.hpp"
#include "petal/calibration/target.hpp"

namespace petal {

/// How far the points beside the sides of a board's holes (at most 3 cm off, within 5 cm of its
/// plane) come to lie from the same sides in the image, px: to the nearest side of the nearest
/// hole, between the image's corners of it. Empty for targets without polygonal holes.
std::vector<double> point_to_edge(const CameraModel& model, const Eigen::Isometry3d& T_camera_lidar,
                                  const Cloud& cloud, const LidarBoard& lidar,
                                  const ImageBoard& image, const PosedMatch& match,
                                  const Target& target);

}  // namespace petal
