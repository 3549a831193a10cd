// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "petal/calibration/cloud.hpp"
#include "sinks/detail/point_colours.hpp"

namespace petal {

/// A cloud and the colour of each of its points; those that are not to be written have no place in
/// `index`.
struct ColoredPoints {
    const Cloud* cloud = nullptr;
    std::vector<PointColour> colours;  ///< of every point of the cloud
    std::vector<std::uint32_t> index;  ///< of the points to write
    std::size_t colored = 0;           ///< by a photo; the others are grey
};

/// Writes PLY, binary: x y z (float, m, the LiDAR's frame) and red green blue (uchar).
void write_colored_ply(const ColoredPoints& points, const std::filesystem::path& file);

/// A camera to draw as a frame of axes: T_lidar_camera.
struct SceneCamera {
    std::string label;
    Eigen::Isometry3d T_lidar_camera;
};

/// Writes MRPT's .3Dscene with the points, the LiDAR's axes and the cameras': SceneViewer3D opens
/// it. \throws Error when the file cannot be written.
void write_colored_scene(const ColoredPoints& points, const std::vector<SceneCamera>& cameras,
                         const std::filesystem::path& file);

}  // namespace petal
