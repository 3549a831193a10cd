// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "petal/calibration/camera_model.hpp"
#include "petal/calibration/correspondences.hpp"

namespace petal {

/// Whether the points lie in one plane but not on one line: the third singular value is below 2 %
/// of the second, which is above 1 % of the first.
bool is_planar(const std::vector<Eigen::Vector3d>& points);

/// Both minima of the planar pose problem (Collins and Bartoli's IPPE, by OpenCV), poses
/// T_camera_lidar with every point in front of the camera. Points off their best plane are moved
/// onto it. At least four pairs; empty where they are degenerate.
std::vector<Eigen::Isometry3d> planar_poses(const CameraModel& model,
                                            const std::vector<PointPair>& pairs);

/// One of OpenCV's deterministic methods: "iterative", "epnp", "sqpnp", "ippe". Raw pixels are
/// undistorted first; pairs whose pixel has no direction are left out. Poses with a point behind
/// the camera are dropped; empty where OpenCV gives none.
std::vector<Eigen::Isometry3d> pnp_poses(const std::string& method, const CameraModel& model,
                                         const std::vector<PointPair>& pairs);

/// Where to start from without an initial guess: both planar minima of each board, of everything
/// where it is planar, SQPNP and (where it is not planar) EPnP of everything. Deterministic.
std::vector<Eigen::Isometry3d> pose_starts(const CameraModel& model,
                                           const std::vector<PointPair>& pairs);

}  // namespace petal
