// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <mrpt/img/TCamera.h>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstddef>
#include <string>
#include <vector>

#include "petal/calibration/boards.hpp"
#include "petal/calibration/correspondences.hpp"
#include "petal/calibration/extrinsics.hpp"
#include "petal/packet.hpp"

namespace petal {

/// A board that LiDAR and camera see, with the pose that is to be judged. The pose may be that of
/// other scenes than this one.
struct SeenBoard {
    std::uint64_t scene = 0;  ///< frame number
    std::string scene_name;
    std::string camera;
    std::string target;  ///< name; empty where no LidarBoards tell it
    mrpt::img::TCamera model;
    Eigen::Isometry3d T_camera_lidar = Eigen::Isometry3d::Identity();
    std::vector<PointPair> corners;
};

struct SeenBoards {
    std::vector<SeenBoard> boards;  ///< by scene
    std::size_t unsolved = 0;       ///< boards of cameras without extrinsics
    std::size_t single = 0;         ///< pairs that are no corner of a board
};

/// The board pairs of all scenes. The model is the solver's; where the extrinsics bring none (an
/// earlier result), that of the pairs with the focal length which that result estimated. `lidar`
/// may be empty: then targets have no names.
SeenBoards seen_boards(const std::vector<Packet<Extrinsics>>& extrinsics,
                       const std::vector<Packet<Correspondences>>& correspondences,
                       const std::vector<Packet<LidarBoards>>& lidar);

}  // namespace petal
