// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "petal/packet.hpp"

namespace petal {

/// What is known of a simulated scene. Empty (no T_camera_lidar, no boards) for real data.
struct Truth {
    struct Board {
        std::string target;
        Eigen::Isometry3d T_lidar_board = Eigen::Isometry3d::Identity();
        std::vector<Eigen::Vector3d> corners_lidar;  ///< m
        std::vector<Eigen::Vector2d> corners_image;  ///< raw pixels
    };

    std::optional<Eigen::Isometry3d> T_camera_lidar;
    std::vector<Board> boards;
    /// A byte a point, in rawlog order: 0 background, 1 board, 2 vacant, 3 other foreground.
    std::vector<std::uint8_t> labels;

    bool empty() const { return !T_camera_lidar && boards.empty() && labels.empty(); }
};

template <>
struct PacketTraits<Truth> {
    static constexpr const char* name = "Truth";
    static void seal(Truth& truth);
    static std::size_t bytes(const Truth& truth);
};

}  // namespace petal
