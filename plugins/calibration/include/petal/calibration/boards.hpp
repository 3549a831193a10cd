// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <mrpt/img/TCamera.h>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "petal/packet.hpp"

namespace petal {

using Matrix6d = Eigen::Matrix<double, 6, 6>;

/// A board as the LiDAR sees it. Which of its sides is the upper one the LiDAR alone cannot tell:
/// the order here is row by row from the top left for an observer at the sensor whose up is the
/// LiDAR's +z (its +x where +z is along the normal). The matcher decides the true order.
struct LidarBoard {
    std::string target;  ///< Target::name
    Eigen::Isometry3d T_lidar_board = Eigen::Isometry3d::Identity();
    std::vector<Eigen::Vector3d> corners;   ///< Target::corners() in the LiDAR frame, m
    std::optional<Matrix6d> covariance;     ///< of the pose, left perturbation (rho, phi)
    std::map<std::string, double> quality;  ///< named figures, unit in the name
};

struct LidarBoards {
    std::string lidar;  ///< sensor label
    std::vector<LidarBoard> boards;
    /// What casts doubt on the target, the data or the boards, in words for the verdict's reasons.
    std::vector<std::string> findings = {};
};

/// A board as one camera sees it, row by row from the top left in the image.
struct ImageBoard {
    std::string target;
    std::string camera;                       ///< label
    std::vector<Eigen::Vector2d> corners;     ///< raw pixels
    std::vector<Eigen::Matrix2d> covariance;  ///< of each corner, px^2
    /// Of all corners together, 2N x 2N, u0 v0 u1 v1 ..., px^2: corners share the lines they are
    /// cut from. Empty where the detector does not know it.
    Eigen::MatrixXd joint_covariance = {};
    std::map<std::string, double> quality;
};

/// A camera that looked for boards, whether or not it found one.
struct CameraInfo {
    std::string label;
    mrpt::img::TCamera camera;
};

struct ImageBoards {
    std::vector<CameraInfo> cameras;
    std::vector<ImageBoard> boards;
    std::vector<std::string> findings = {};  ///< as those of LidarBoards
};

template <>
struct PacketTraits<LidarBoards> {
    static constexpr const char* name = "LidarBoards";
    static void seal(LidarBoards& boards);
    static std::size_t bytes(const LidarBoards& boards);
};

template <>
struct PacketTraits<ImageBoards> {
    static constexpr const char* name = "ImageBoards";
    static void seal(ImageBoards& boards);
    static std::size_t bytes(const ImageBoards& boards);
};

}  // namespace petal
