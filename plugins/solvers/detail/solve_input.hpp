// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <mrpt/img/TCamera.h>

#include <Eigen/Geometry>
#include <cstdint>
#include <string>
#include <vector>

#include "petal/calibration/camera_model.hpp"
#include "petal/calibration/correspondences.hpp"
#include "petal/calibration/same_projection.hpp"
#include "petal/run.hpp"

namespace petal {

/// What one camera and one LiDAR have in common over all scenes.
struct SolveInput {
    /// Where a pair comes from.
    struct Origin {
        std::uint64_t scene = 0;  ///< frame number
        int board = -1;           ///< in its scene; -1 for a single point
        int corner = -1;
    };

    std::string camera;
    std::string lidar;
    mrpt::img::TCamera model;
    std::vector<PointPair> pairs;            ///< `board` counts over all scenes
    std::vector<Origin> origins;             ///< of each pair
    OrderDecision order;                     ///< the worst of the scenes'
    std::vector<Eigen::Isometry3d> initial;  ///< each once
};

/// The model to project with: without distortion where the pixels are rectified already.
CameraModel camera_model(const mrpt::img::TCamera& camera, bool use_distortion);

/// One input for each pair of labels, in the order of their first appearance; scenes in the order
/// of CameraPairs::scene. A camera without any pair is told with the LiDAR label that it came
/// with. \throws Error where a camera's intrinsics differ between scenes.
std::vector<SolveInput> gather(const std::vector<Packet<Correspondences>>& packets);

}  // namespace petal
