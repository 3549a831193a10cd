// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "petal/calibration/boards.hpp"
#include "petal/calibration/camera_model.hpp"
#include "petal/calibration/se3.hpp"

namespace petal {

/// A board of one scene: what the LiDAR and every camera that sees it say of it.
struct JointBoard {
    /// The board in one camera's image.
    struct View {
        std::size_t camera = 0;                ///< index in JointModel::cameras
        std::vector<Eigen::Vector3d> corners;  ///< in the frame of T_lidar_board, m
        std::vector<Eigen::Vector2d> image;    ///< raw pixels
        /// m x 2N: whitens u0 v0 u1 v1 ...; m is the rank of the corners' covariance.
        Eigen::MatrixXd whitening;
    };

    std::size_t scene = 0;  ///< index in JointModel::scenes
    Eigen::Isometry3d T_lidar_board = Eigen::Isometry3d::Identity();  ///< as measured
    Matrix6d covariance = Matrix6d::Identity();        ///< of it, left perturbation (rho, phi)
    Matrix6d whitening = Matrix6d::Identity();         ///< of (rho, phi)
    Eigen::Vector3d centre = Eigen::Vector3d::Zero();  ///< of the corners, in the LiDAR frame, m
    bool assumed = false;                              ///< the covariance was not measured
    std::vector<View> views;
};

/// A single point of the LiDAR and where one camera sees it.
struct JointPoint {
    std::size_t camera = 0, scene = 0;
    Eigen::Vector3d lidar = Eigen::Vector3d::Zero();           ///< m
    Eigen::Vector2d image = Eigen::Vector2d::Zero();           ///< raw pixels
    Eigen::Matrix2d covariance = Eigen::Matrix2d::Identity();  ///< of `image`, px^2
    /// How many times fewer independent numbers it holds than two: corners of a board that nothing
    /// more is known of.
    double redundancy = 1.0;
};

/// Everything that one LiDAR and the cameras that share boards with each other have seen.
struct JointModel {
    struct Scene {
        std::uint64_t number = 0;
        std::string name;
    };

    std::vector<CameraModel> cameras;
    std::vector<Scene> scenes;
    std::vector<JointBoard> boards;
    std::vector<JointPoint> points;
    double point_sigma = 0.0;  ///< m, of a point of `points` along each axis
};

/// What is solved for.
struct JointState {
    std::vector<Eigen::Isometry3d> T_camera_lidar;
    std::vector<Eigen::Isometry3d> T_lidar_board;
    std::vector<double> focal;          ///< factor on fx and fy of each camera
    double range_offset = 0.0;          ///< m: what the LiDAR measures too far
    std::vector<double> board_weights;  ///< by the robust loss
    std::vector<double> point_weights;  ///< likewise
};

/// The whitened error of a board's corners in one image, and its derivatives; rows as whitening's.
struct ViewLinear {
    Eigen::VectorXd error;
    Eigen::Matrix<double, Eigen::Dynamic, 6> by_camera;  ///< left perturbation of T_camera_lidar
    Eigen::Matrix<double, Eigen::Dynamic, 6> by_board;   ///< left perturbation of T_lidar_board
    Eigen::VectorXd by_focal;
    Eigen::Matrix<double, Eigen::Dynamic, 2> by_centre;  ///< by cx and cy
};
/// False where a corner does not project.
bool linearise(const CameraModel& model, const JointBoard::View& view,
               const Eigen::Isometry3d& T_camera_lidar, const Eigen::Isometry3d& T_lidar_board,
               double focal, ViewLinear& out);

/// The whitened Log(T M^-1) of a board's pose T against its measurement M.
struct BoardLinear {
    Vector6d error;
    Matrix6d by_board;
    Vector6d by_range;  ///< by a constant offset of the LiDAR's ranges, m
};
BoardLinear linearise(const JointBoard& board, const Eigen::Isometry3d& T_lidar_board,
                      double range_offset);

/// The whitened error of a point, with both sensors' noise. False where it does not project.
struct PointLinear {
    Eigen::Vector2d error;
    Eigen::Matrix<double, 2, 6> by_camera;
    Eigen::Vector2d by_focal, by_range;
    Eigen::Matrix2d by_centre;
    Eigen::Matrix2d whitening;
};
/// `whitening`, where given, is used instead of that at this pose.
bool linearise(const CameraModel& model, const JointPoint& point, double point_sigma,
               const Eigen::Isometry3d& T_camera_lidar, double focal, double range_offset,
               PointLinear& out, const Eigen::Matrix2d* whitening = nullptr);

/// W with W'W the pseudo-inverse of a covariance of pixels. Directions with less than 1e-6 of the
/// largest variance are left out: corners cut from eight lines do not move there at all. The others
/// are not taken as better than `min_sigma_px`. \throws Error where the matrix is no covariance
/// (NaN, a variance below -1e-6 of the largest) or fewer than six directions are left; `who` is
/// named.
Eigen::MatrixXd pixel_whitening(const Eigen::MatrixXd& covariance, double min_sigma_px,
                                const std::string& who);

/// The covariance (rho, phi) of a pose that errs by `sigma` (m) and `sigma_rotation` (rad) at and
/// about `centre`.
Matrix6d covariance_about(const Eigen::Vector3d& centre, double sigma, double sigma_rotation);

}  // namespace petal
