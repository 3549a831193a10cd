// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <mrpt/img/TCamera.h>

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "petal/calibration/boards.hpp"
#include "petal/packet.hpp"

namespace petal {

/// What one LiDAR and one camera saw in one scene.
struct MatcherScene {
    std::uint64_t number = 0;
    std::string name;
    const LidarBoards* lidar = nullptr;  ///< null where the LiDAR told nothing
    const ImageBoards* images = nullptr;
    std::vector<int> image;  ///< the camera's boards: indices into images->boards

    std::size_t lidar_boards() const { return lidar == nullptr ? 0 : lidar->boards.size(); }
};

/// One LiDAR and one camera, over all scenes in the order of their numbers.
struct MatcherCamera {
    std::string camera;
    std::string lidar;
    mrpt::img::TCamera model;
    std::vector<MatcherScene> scenes;
};

/// Sorts what was gathered by camera and LiDAR label, in the order of their first appearance; the
/// packets must outlive what is returned. A scene without a packet of the LiDAR has no LiDAR
/// boards. \throws Error naming the scene: two packets of a port for it, a board with fewer than
/// four corners, NaN, covariances that do not fit it or are none, a camera that is not listed; and
/// where a camera's intrinsics differ between scenes.
std::vector<MatcherCamera> matcher_cameras(const std::vector<Packet<LidarBoards>>& lidar,
                                           const std::vector<Packet<ImageBoards>>& image);

}  // namespace petal
