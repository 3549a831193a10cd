// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <mrpt/img/TCamera.h>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "petal/calibration/boards.hpp"
#include "petal/packet.hpp"

namespace petal {

/// A point of the LiDAR frame and where one camera sees it.
struct PointPair {
    Eigen::Vector3d lidar;  ///< m
    Eigen::Vector2d image;  ///< raw pixels
    Eigen::Matrix2d covariance =
        Eigen::Matrix2d::Identity();  ///< of `image`, px^2; relative weights
    int board = -1;   ///< index of the board pair in its scene; -1 for a single point
    int corner = -1;  ///< index in Target::corners(); -1 for a single point
};

/// How it was decided which image corner belongs to which LiDAR corner.
enum class DecidedBy {
    given,      ///< the input said so (published pairs)
    data,       ///< the residuals: the refined runner-up is clearly worse
    prior,      ///< the declared priors, among orders that fit alike
    undecided,  ///< orders fit alike and no prior is on
};
const char* to_string(DecidedBy by);

struct OrderDecision {
    DecidedBy by = DecidedBy::undecided;
    double rms_px = 0.0;  ///< of the order taken, refined
    double runner_up_rms_ratio =
        0.0;                      ///< RMS of the best other order over that; 0 where there is none
    double runner_up_chi2 = 0.0;  ///< chi-square of the runner-up less that of the order taken
    bool contradicts_priors = false;  ///< decided by data, against a prior that is on
    std::string reason;               ///< plain words, for the verdict
};

/// The pairs of one scene and one camera.
struct CameraPairs {
    std::uint64_t scene = 0;  ///< frame number
    std::string scene_name;
    std::string camera;  ///< label
    std::string lidar;   ///< label
    mrpt::img::TCamera model;
    std::vector<PointPair> pairs;
    OrderDecision order;
    /// Poses T_camera_lidar that the matcher found, the best first; a solver may start from them.
    std::vector<Eigen::Isometry3d> initial;
    /// A board that both sensors see. Its pairs are those with its index as PointPair::board.
    struct BoardPair {
        int lidar = -1;  ///< index in LidarBoards::boards of this scene
        int image = -1;  ///< index in ImageBoards::boards of this scene
        /// Turned so that the board's corners have the order that the camera sees.
        Eigen::Isometry3d T_lidar_board = Eigen::Isometry3d::Identity();
        std::optional<Matrix6d> pose_covariance = {};  ///< LidarBoard::covariance
        std::vector<Eigen::Vector3d> corners_board =
            {};  ///< Target::corners() in the board frame, m
        std::vector<Eigen::Vector2d> corners_image = {};  ///< raw pixels, as corners_board
        Eigen::MatrixXd image_covariance = {};            ///< of them together, 2N x 2N, px^2
    };
    std::vector<BoardPair> boards;
};

struct Correspondences {
    /// One for each scene and camera, also those without a pair. A packet holds one scene or all.
    std::vector<CameraPairs> cameras;
};

template <>
struct PacketTraits<Correspondences> {
    static constexpr const char* name = "Correspondences";
    static void seal(Correspondences& correspondences);
    static std::size_t bytes(const Correspondences& correspondences);
};

}  // namespace petal
