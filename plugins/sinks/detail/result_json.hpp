// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <Eigen/Geometry>
#include <memory>
#include <string>
#include <vector>

#include "petal/calibration/boards.hpp"
#include "petal/calibration/correspondences.hpp"
#include "petal/calibration/extrinsics.hpp"
#include "petal/calibration/metrics.hpp"
#include "petal/packet.hpp"

namespace petal {

/// What result.json is made of; only the extrinsics must be there.
struct ResultInput {
    std::shared_ptr<const Extrinsics> extrinsics;
    std::vector<Packet<Correspondences>> correspondences;
    std::vector<Packet<LidarBoards>> lidar_boards;
    std::vector<Packet<ImageBoards>> image_boards;
    std::vector<Packet<Metrics>> metrics;
};

/// The text of result.json; see the stage's page for its content.
std::string result_json(const ResultInput& input);

/// "the LiDAR sits 4.6 cm left of, 15.1 cm below and 6.7 cm behind the camera": the origin of the
/// LiDAR in the camera frame (x right, y down, z forward), to the millimetre.
std::string placement_sentence(const Eigen::Isometry3d& T_camera_lidar);

}  // namespace petal
