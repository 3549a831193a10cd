// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <mrpt/img/TCamera.h>

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "petal/calibration/angles.hpp"
#include "petal/calibration/boards.hpp"
#include "petal/calibration/camera_model.hpp"
#include "petal/calibration/correspondences.hpp"
#include "petal/calibration/se3.hpp"

namespace petal::testing {

/// Where the board of four square holes stands: its centre in the LiDAR frame (x forward, y left, z
/// up), and how it is turned from facing the sensor upright.
struct Placement {
    Eigen::Vector3d centre;
    double yaw_deg = 0.0, pitch_deg = 0.0, roll_deg = 0.0;
};

/// The boards of a rig's scenes as two honest detectors would have them: poses and pixels off by
/// noise of the covariance that they tell. The camera (f 920 px) looks along the LiDAR's x.
class MadeRig {
   public:
    struct Noise {
        double shift = 0.003;          ///< m, of a board's place in the LiDAR frame, each axis
        double turn = 0.3 / kDegrees;  ///< rad, of its rotation, each axis
        double px = 0.2;               ///< of an image corner, each axis
        double told = 1.0;             ///< what the detectors tell, over what it is
    };
    struct Seen {
        LidarBoards lidar;
        ImageBoards image;
    };

    MadeRig(unsigned seed, Noise noise) : noise_(noise), random_(seed) {
        camera_.ncols = 1280;
        camera_.nrows = 1024;
        camera_.setIntrinsicParamsFromValues(920.0, 920.0, 640.0, 512.0);
        T_camera_lidar_.linear() << 0, -1, 0, 0, 0, -1, 1, 0, 0;
        Vector6d off;
        off << 0.05, -0.10, 0.06, 0.02, -0.03, 0.01;
        T_camera_lidar_ = se3_exp(off) * T_camera_lidar_;
    }
    explicit MadeRig(unsigned seed) : MadeRig(seed, Noise()) {}

    const Eigen::Isometry3d& T_camera_lidar() const { return T_camera_lidar_; }
    const mrpt::img::TCamera& camera() const { return camera_; }

    Seen scene() const {
        Seen seen;
        seen.lidar.lidar = "LIDAR";
        seen.image.cameras.push_back({"CAMERA", camera_});
        return seen;
    }

    /// Adds a board, a little off its placement (5 cm, 3 deg, as the simulator's sets are), to what
    /// the LiDAR sees, the camera, or both. The LiDAR's corner order is turned by `k` quarters.
    void add(Seen& scene, Placement at, bool in_lidar = true, bool in_image = true, int k = 0) {
        for (int i = 0; i < 3; ++i) at.centre(i) += uniform(0.05);
        at.yaw_deg += uniform(3.0);
        at.pitch_deg += uniform(3.0);
        at.roll_deg += uniform(3.0);
        const Eigen::Isometry3d truth = pose(at);
        if (in_lidar) scene.lidar.boards.push_back(lidar_board(truth, k));
        if (in_image) scene.image.boards.push_back(image_board(truth));
    }
    std::mt19937& random() { return random_; }

   private:
    double uniform(double most) {
        return std::uniform_real_distribution<double>(-most, most)(random_);
    }
    double normal(double sigma) { return std::normal_distribution<double>(0.0, sigma)(random_); }

    /// T_lidar_board, origin at the upper left corner.
    static Eigen::Isometry3d pose(const Placement& at) {
        Eigen::Matrix3d facing;  // x right, y down, z away
        facing << 0, 0, 1, -1, 0, 0, 0, -1, 0;
        Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
        T.linear() =
            facing * (Eigen::AngleAxisd(at.yaw_deg / kDegrees, Eigen::Vector3d::UnitY()) *
                      Eigen::AngleAxisd(at.pitch_deg / kDegrees, Eigen::Vector3d::UnitX()) *
                      Eigen::AngleAxisd(at.roll_deg / kDegrees, Eigen::Vector3d::UnitZ()))
                         .toRotationMatrix();
        T.translation() = at.centre - T.linear() * Eigen::Vector3d(0.25, 0.25, 0.0);
        return T;
    }
    static std::vector<Eigen::Vector3d> target() {
        std::vector<Eigen::Vector3d> corners;
        for (int row = 1; row <= 4; ++row)
            for (int column = 1; column <= 4; ++column)
                corners.emplace_back(0.1 * column, 0.1 * row, 0.0);
        return corners;
    }

    LidarBoard lidar_board(const Eigen::Isometry3d& truth, int k) {
        const Eigen::Vector3d centre(0.25, 0.25, 0.0);
        Eigen::Isometry3d turn = Eigen::Isometry3d::Identity();
        turn.linear() =
            Eigen::AngleAxisd(0.5 * kPi * k, Eigen::Vector3d::UnitZ()).toRotationMatrix();
        turn.translation() = centre - turn.linear() * centre;
        // Noise about the board's centre, along the LiDAR's axes; told as a left perturbation.
        const Eigen::Vector3d middle = truth * centre;
        Matrix6d about = Matrix6d::Identity();  // rho = d - phi x c
        about.topRightCorner<3, 3>() = skew(middle);
        Vector6d sigma;
        sigma << Eigen::Vector3d::Constant(noise_.shift), Eigen::Vector3d::Constant(noise_.turn);
        Vector6d error;
        for (int i = 0; i < 6; ++i) error(i) = normal(sigma(i));
        LidarBoard board;
        board.target = "four_square_holes_500mm";
        board.T_lidar_board = se3_exp(about * error) * truth * turn;
        const Vector6d variance = (noise_.told * sigma).cwiseAbs2();
        board.covariance = about * variance.asDiagonal() * about.transpose();
        for (const auto& corner : target()) board.corners.push_back(board.T_lidar_board * corner);
        return board;
    }
    ImageBoard image_board(const Eigen::Isometry3d& truth) {
        const CameraModel model(camera_);
        const double variance = std::pow(noise_.told * noise_.px, 2);
        ImageBoard board;
        board.target = "four_square_holes_500mm";
        board.camera = "CAMERA";
        for (const auto& corner : target()) {
            const Eigen::Vector2d pixel = model.project(T_camera_lidar_ * truth * corner).value();
            board.corners.emplace_back(pixel.x() + normal(noise_.px),
                                       pixel.y() + normal(noise_.px));
            board.covariance.push_back(variance * Eigen::Matrix2d::Identity());
        }
        const auto numbers = 2 * static_cast<Eigen::Index>(board.corners.size());
        board.joint_covariance =
            noise_.px * noise_.px * Eigen::MatrixXd::Identity(numbers, numbers);
        return board;
    }

    Noise noise_;
    std::mt19937 random_;
    mrpt::img::TCamera camera_;
    Eigen::Isometry3d T_camera_lidar_ = Eigen::Isometry3d::Identity();
};

/// The simulator's sets: placements of one rig, one board a scene.
inline std::vector<Placement> one_flat() {
    return {{{3.0, 0.0, 0.0}}};
}
inline std::vector<Placement> three_yaw() {
    return {{{3.0, 0.0, 0.0}, 0.0}, {{2.9, 0.9, 0.0}, 20.0}, {{2.9, -0.9, 0.0}, -20.0}};
}
inline std::vector<Placement> four_diverse() {
    return {{{2.3, 0.25, 0.0}, 15, -12, 3},
            {{3.0, 0.95, 0.25}, 30, 12, -5},
            {{3.2, -0.95, -0.25}, -28, -10, 6},
            {{4.2, -0.3, 0.35}, -10, 22, -3}};
}
inline std::vector<Placement> six_diverse() {
    auto all = four_diverse();
    all.push_back({{4.0, 1.2, -0.3}, 22, -18, 8});
    all.push_back({{3.8, -1.2, 0.35}, -32, 15, -8});
    return all;
}
/// Of one scene: side by side at one distance.
inline std::vector<Placement> two_beside() {
    return {{{4.0, 0.45, 0.0}, 8, 0, 0}, {{4.0, -0.45, 0.0}, -8, 0, 0}};
}

/// Whether every pair of matched boards is right: where the true pose puts the LiDAR's corners, the
/// camera sees them, to half of what the next corner would be off.
inline bool order_is_right(const std::vector<CameraPairs>& scenes,
                           const Eigen::Isometry3d& T_camera_lidar) {
    for (const CameraPairs& scene : scenes)
        for (const PointPair& pair : scene.pairs) {
            const auto pixel = CameraModel(scene.model).project(T_camera_lidar * pair.lidar);
            if (!pixel) return false;
            const double depth = (T_camera_lidar * pair.lidar).z();
            if ((*pixel - pair.image).norm() > 0.05 * scene.model.fx() / depth) return false;
        }
    return true;
}

}  // namespace petal::testing
