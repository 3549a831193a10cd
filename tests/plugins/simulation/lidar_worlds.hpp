// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "simulation/lidar/lidar_simulation.hpp"
#include "simulation/world/surfaces.hpp"
#include "simulation/world/world.hpp"

namespace petal::simulation {

inline std::shared_ptr<const Texture> reflecting(float reflectivity) {
    return std::make_shared<PlainTexture>(Look{Eigen::Vector3f::Constant(0.5F), reflectivity});
}

/// From a surface's frame (x right, y down, z away as the LiDAR sees it) to the LiDAR's: its origin
/// at `corner`, turned by `yaw_deg` about the upright.
inline Eigen::Isometry3d before_lidar(const Eigen::Vector3d& corner, double yaw_deg = 0.0) {
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    pose.linear() << 0, 0, 1, -1, 0, 0, 0, -1, 0;
    pose.prerotate(Eigen::AngleAxisd(yaw_deg * 0.017453292519943295, Eigen::Vector3d::UnitZ()));
    pose.pretranslate(corner);
    return pose;
}

/// A wall of `size` m across the x axis at `range`.
inline void add_wall(World& world, double range, double size, float reflectivity,
                     Kind kind = Kind::background) {
    world.add(std::make_unique<PlanarSurface>(before_lidar({range, 0.5 * size, 0.5 * size}),
                                              PlanarSurface::rectangle(size, size),
                                              reflecting(reflectivity), kind));
}

/// The front of the letter's board, its middle on the x axis at `range`: 0.5 m, four holes of 0.1
/// m.
inline void add_four_holes(World& world, double range, float reflectivity) {
    auto shape = PlanarSurface::rectangle(0.5, 0.5);
    for (const double y : {0.1, 0.3})
        for (const double x : {0.1, 0.3})
            shape.holes.push_back({{x, y}, {x + 0.1, y}, {x + 0.1, y + 0.1}, {x, y + 0.1}});
    world.add(std::make_unique<PlanarSurface>(before_lidar({range, 0.25, 0.25}), shape,
                                              reflecting(reflectivity), Kind::board));
}

/// A LiDAR without errors of its own: tests add what they are about.
inline LidarDevice exact_lidar(const char* name) {
    LidarDevice device;
    device.profile = load_lidar_profile(name);
    device.profile.range_noise_near = device.profile.range_noise_far = 0.0;
    device.profile.angular_noise = device.profile.intensity_noise = 0.0;
    device.profile.late_error = device.profile.quantisation = device.profile.dropout = 0.0;
    return device;
}

/// All points of all messages, one a column, m.
inline Eigen::Matrix3Xd points_of(const std::vector<LidarMessage>& messages) {
    std::size_t count = 0;
    for (const LidarMessage& message : messages) count += message.x.size();
    Eigen::Matrix3Xd points(3, static_cast<Eigen::Index>(count));
    Eigen::Index next = 0;
    for (const LidarMessage& message : messages)
        for (std::size_t i = 0; i < message.x.size(); ++i)
            points.col(next++) =
                Eigen::Vector3f(message.x[i], message.y[i], message.z[i]).cast<double>();
    return points;
}

}  // namespace petal::simulation
