// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <mrpt/img/TCamera.h>

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>
#include <cstdint>
#include <random>
#include <string>
#include <vector>

#include "petal/calibration/angles.hpp"
#include "petal/calibration/camera_model.hpp"
#include "petal/calibration/correspondences.hpp"
#include "petal/calibration/se3.hpp"
#include "solvers/detail/joint_model.hpp"

namespace petal::testing {

/// Boards as the joint solver's own noise model has them: poses with errors at and about their
/// centres, corners cut from eight lines each of which is off and askew.
struct JointScenes {
    struct Placement {
        Eigen::Vector3d centre;  ///< in the LiDAR frame (x ahead, z up), m
        double yaw_deg = 0.0, pitch_deg = 0.0, roll_deg = 0.0;
    };

    std::vector<Placement> placements;
    double lidar_sigma = 0.002;  ///< m
    double lidar_sigma_deg = 0.1;
    double line_sigma_px = 0.1;  ///< of a line in its middle, and at its ends by its slope
    double drawn = 1.0;          ///< the noise that is drawn, of that which is told
    double range_offset = 0.0;   ///< m, of the LiDAR
    double focal_told = 920.0;   ///< px; the true one is 920

    static JointScenes four_diverse() {
        return {{{{2.3, 0.25, 0.0}, 15, -12, 3},
                 {{3.0, 0.95, 0.25}, 30, 12, -5},
                 {{3.2, -0.95, -0.25}, -28, -10, 6},
                 {{4.2, -0.3, 0.35}, -10, 22, -3}}};
    }
    static JointScenes six_diverse() {
        JointScenes scenes = four_diverse();
        scenes.placements.push_back({{4.0, 1.2, -0.3}, 22, -18, 8});
        scenes.placements.push_back({{3.8, -1.2, 0.35}, -32, 15, -8});
        return scenes;
    }
    static JointScenes three_yaw() {
        return {{{{3.5, 0.0, 0.0}, 0, 0, 0},
                 {{3.5, 0.9, 0.0}, 30, 0, 0},
                 {{3.5, -0.9, 0.0}, -30, 0, 0}}};
    }
    static JointScenes one_flat() { return {{{{3.5, 0.0, 0.0}, 0, 0, 0}}}; }

    static Eigen::Isometry3d true_pose() {
        Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
        pose.linear() << 0, -1, 0, 0, 0, -1, 1, 0, 0;
        Vector6d twist;
        twist << 0.04, -0.11, -0.03, 0.02, -0.03, 0.01;
        return se3_exp(twist) * pose;
    }
    static mrpt::img::TCamera camera(double focal) {
        mrpt::img::TCamera made;
        made.setIntrinsicParamsFromValues(focal, focal, 640.0, 360.0);
        made.ncols = 1280;
        made.nrows = 720;
        return made;
    }
    static std::vector<Eigen::Vector3d> corners() {
        std::vector<Eigen::Vector3d> made;
        for (int row = 1; row <= 4; ++row)
            for (int column = 1; column <= 4; ++column)
                made.emplace_back(0.1 * column, 0.1 * row, 0.0);
        return made;
    }
    static Eigen::Isometry3d board_pose(const Placement& placement) {
        Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
        pose.linear() << 0, 0, 1, -1, 0, 0, 0, -1, 0;
        const auto turn = [](double deg, const Eigen::Vector3d& axis) {
            return Eigen::AngleAxisd(deg / kDegrees, axis);
        };
        pose.linear() = turn(placement.yaw_deg, Eigen::Vector3d::UnitZ()) *
                        turn(placement.pitch_deg, Eigen::Vector3d::UnitY()) *
                        turn(placement.roll_deg, Eigen::Vector3d::UnitX()) * pose.linear();
        pose.translation() = placement.centre - pose.linear() * Eigen::Vector3d(0.25, 0.25, 0.0);
        return pose;
    }

    /// d corners / d (offset and slope of each of the eight lines): 32 x 16.
    static Eigen::MatrixXd line_map(const std::vector<Eigen::Vector2d>& pixels) {
        Eigen::MatrixXd map = Eigen::MatrixXd::Zero(32, 16);
        const auto at = [&](int row, int column) {
            return pixels[static_cast<std::size_t>(4 * row + column)];
        };
        for (int row = 0; row < 4; ++row)
            for (int column = 0; column < 4; ++column) {
                const auto end = [](const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
                    return Eigen::Vector2d(0.5 * (b - a));
                };
                const Eigen::Vector2d across = end(at(row, 0), at(row, 3));
                const Eigen::Vector2d down = end(at(0, column), at(3, column));
                const Eigen::Vector2d middle_across = at(row, 0) + across;
                const Eigen::Vector2d middle_down = at(0, column) + down;
                Eigen::Matrix2d normals;
                normals << -across.y(), across.x(), -down.y(), down.x();
                normals.row(0) /= across.norm();
                normals.row(1) /= down.norm();
                const Eigen::Matrix2d cut = normals.inverse();
                const double s =
                    (at(row, column) - middle_across).dot(across) / across.squaredNorm();
                const double t = (at(row, column) - middle_down).dot(down) / down.squaredNorm();
                const int corner = 2 * (4 * row + column);
                map.block<2, 1>(corner, 2 * row) = cut.col(0);
                map.block<2, 1>(corner, 2 * row + 1) = s * cut.col(0);
                map.block<2, 1>(corner, 8 + 2 * column) = cut.col(1);
                map.block<2, 1>(corner, 8 + 2 * column + 1) = t * cut.col(1);
            }
        return map;
    }

    /// One packet with all scenes, each placement a scene of its own, called "a", "b", ...
    Correspondences draw(std::uint64_t seed, const Eigen::Isometry3d& T_camera_lidar = true_pose(),
                         const std::string& label = "CAMERA") const {
        std::mt19937_64 rng(seed);
        std::normal_distribution<double> normal(0.0, 1.0);
        const CameraModel truth(camera(920.0));
        Correspondences all;
        // The LiDAR's noise first, so that a second camera meets the same boards.
        std::vector<Vector6d> errors;
        for (std::size_t i = 0; i < placements.size(); ++i)
            errors.push_back(Vector6d::NullaryExpr([&](Eigen::Index) { return normal(rng); }));
        if (label != "CAMERA") rng.seed(seed + 1000003);
        for (std::size_t i = 0; i < placements.size(); ++i) {
            CameraPairs seen;
            seen.scene = i;
            seen.scene_name = std::string(1, static_cast<char>('a' + i));
            seen.camera = label;
            seen.lidar = "LIDAR";
            seen.model = camera(focal_told);
            seen.order.by = DecidedBy::data;
            CameraPairs::BoardPair board;
            board.lidar = board.image = 0;
            board.corners_board = corners();
            const Eigen::Isometry3d pose = board_pose(placements[i]);
            board.pose_covariance =
                covariance_about(placements[i].centre, lidar_sigma, lidar_sigma_deg / kDegrees);
            const Eigen::LLT<Matrix6d> root(*board.pose_covariance);
            Vector6d xi = root.matrixL() * errors[i];
            xi *= drawn;
            Eigen::Isometry3d measured = se3_exp(-xi) * pose;
            measured.translation() += range_offset * placements[i].centre.normalized();
            board.T_lidar_board = measured;
            std::vector<Eigen::Vector2d> pixels;
            for (const auto& corner : board.corners_board)
                pixels.push_back(*truth.project(T_camera_lidar * (pose * corner)));
            const Eigen::MatrixXd map = line_sigma_px * line_map(pixels);
            board.image_covariance = map * map.transpose();
            const Eigen::VectorXd shift =
                drawn * map *
                Eigen::VectorXd::NullaryExpr(16, [&](Eigen::Index) { return normal(rng); });
            for (std::size_t k = 0; k < pixels.size(); ++k) {
                const auto at = static_cast<Eigen::Index>(2 * k);
                PointPair pair;
                pair.lidar = measured * board.corners_board[k];
                pair.image = pixels[k] + shift.segment<2>(at);
                pair.covariance = board.image_covariance.block<2, 2>(at, at);
                pair.board = 0;
                pair.corner = static_cast<int>(k);
                board.corners_image.push_back(pair.image);
                seen.pairs.push_back(pair);
            }
            seen.boards.push_back(board);
            all.cameras.push_back(seen);
        }
        return all;
    }
};

}  // namespace petal::testing
