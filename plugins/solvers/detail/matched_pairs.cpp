// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "solvers/detail/matched_pairs.hpp"

#include <utility>

#include "petal/calibration/se3.hpp"
#include "solvers/detail/corner_covariance.hpp"

namespace petal {
namespace {

CameraPairs::BoardPair board_pair(const BoardSet& boards, const BoardMatch& match,
                                  const std::vector<PointPair>& corners) {
    const LidarBoard& lidar = *boards.lidar(match).board;
    const ImageBoard& image = *boards.image(match).board;
    CameraPairs::BoardPair pair;
    pair.lidar = boards.lidar(match).index;
    pair.image = boards.image(match).index;
    pair.T_lidar_board = boards.T_lidar_board(match);
    pair.pose_covariance = lidar.covariance;
    const Eigen::Isometry3d T_board_lidar = pair.T_lidar_board.inverse();
    for (const PointPair& corner : corners) {
        pair.corners_board.push_back(T_board_lidar * corner.lidar);
        pair.corners_image.push_back(corner.image);
    }
    pair.image_covariance =
        corner_covariance(image.joint_covariance, image.covariance, image.corners.size());
    return pair;
}

/// Adds what the LiDAR's noise makes in the image to a pair's covariance.
void add_lidar_noise(const CameraModel& model, const Eigen::Isometry3d& pose,
                     const std::optional<Matrix6d>& covariance, double lidar_sigma,
                     PointPair& pair) {
    Eigen::Matrix3d noise = lidar_sigma * lidar_sigma * Eigen::Matrix3d::Identity();
    if (covariance) {
        Eigen::Matrix<double, 3, 6> by_pose;
        by_pose << Eigen::Matrix3d::Identity(), -skew(pair.lidar);
        noise = by_pose * *covariance * by_pose.transpose();
    }
    Eigen::Matrix<double, 2, 3> by_point;
    if (!model.project(pose * pair.lidar, &by_point)) return;
    const Eigen::Matrix<double, 2, 3> by_lidar = by_point * pose.linear();
    pair.covariance += by_lidar * noise * by_lidar.transpose();
}

}  // namespace

void add_matched_pairs(const BoardSet& boards, const OrderChoice& choice, double lidar_sigma,
                       std::vector<CameraPairs>& scenes) {
    for (CameraPairs& scene : scenes) {
        scene.order = choice.decision;
        for (const RefinedPose& pose : choice.order.poses)
            scene.initial.push_back(pose.T_camera_lidar);
    }
    const Eigen::Isometry3d& pose = choice.order.poses.front().T_camera_lidar;
    for (const BoardMatch& match : choice.order.matches) {
        CameraPairs& scene = scenes[boards.lidar(match).scene];
        auto corners = boards.pairs({match});
        CameraPairs::BoardPair pair = board_pair(boards, match, corners);
        for (PointPair& corner : corners) {
            corner.board = static_cast<int>(scene.boards.size());
            add_lidar_noise(boards.model(), pose, pair.pose_covariance, lidar_sigma, corner);
            scene.pairs.push_back(corner);
        }
        scene.boards.push_back(std::move(pair));
    }
}

}  // namespace petal
