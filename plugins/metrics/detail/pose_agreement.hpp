// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <optional>
#include <string>
#include <vector>

#include "petal/calibration/boards.hpp"
#include "petal/calibration/camera_model.hpp"
#include "petal/calibration/se3.hpp"

namespace petal {

/// A LiDAR board and the image board that a given pose puts it on.
struct PosedMatch {
    std::size_t lidar = 0, image = 0;            ///< indices in the packets of the scene
    std::vector<Eigen::Vector3d> lidar_corners;  ///< m, in the order of the image board's
    std::vector<std::size_t> order;  ///< of each image corner: the LiDAR board's corner behind it
};

/// Boards of one scene and camera whose middles lie within `reach` of a board's size (image) of
/// each other under the pose, the nearest first, each used once, in the turn that fits best.
std::vector<PosedMatch> match_by_pose(const CameraModel& model,
                                      const Eigen::Isometry3d& T_camera_lidar,
                                      const LidarBoards& lidar, const ImageBoards& image,
                                      const std::string& camera, double reach);

/// How sure measured boards are taken to be where their detectors do not say.
struct MeasurementNoise {
    double lidar_sigma = 0.005;     ///< m
    double board_redundancy = 4.0;  ///< corners of a board count so many times less
};

/// Sums what boards tell about a drift of a pose: xi = (rho, phi) with T_now = Exp(xi) T_given.
class DriftSum {
   public:
    DriftSum(const CameraModel& model, const Eigen::Isometry3d& T_camera_lidar,
             MeasurementNoise noise)
        : model_(model), T_(T_camera_lidar), noise_(noise) {}

    /// False where a corner does not project.
    bool add(const PosedMatch& match, const LidarBoard& lidar, const ImageBoard& image);

    /// The drift against the covariance of the given pose and of the boards together.
    struct Result {
        Vector6d drift = Vector6d::Zero();  ///< the likeliest; directions that the boards do not
                                            ///< tell stay at 0
        double chi2 = 0.0;                  ///< 6 degrees of freedom
        double sigmas = 0.0;                ///< of a normal distribution with the same probability
        /// What the common drift leaves: how far the boards contradict each other. 6 a board count,
        /// less the drift's 6.
        double left_chi2 = 0.0;
        int left_freedoms = 0;
        double left_sigmas = 0.0;     ///< of a normal distribution; 0 for one board
        double variance_scale = 1.0;  ///< of the boards: max(1, left_chi2 / left_freedoms)
    };
    Result result(const Matrix6d& covariance) const;
    const std::vector<Eigen::Vector2d>& errors() const { return errors_; }

   private:
    const CameraModel& model_;
    Eigen::Isometry3d T_;
    MeasurementNoise noise_;
    Matrix6d information_ = Matrix6d::Zero();
    Vector6d right_ = Vector6d::Zero();
    double chi2_ = 0.0;  ///< of the boards, 6 degrees of freedom each
    int boards_ = 0;
    std::vector<Eigen::Vector2d> errors_;  ///< measured minus projected, raw px
};

/// The normal deviate that is as improbable (one-sided) as a chi-square, by Wilson and Hilferty.
double deviate_of_chi2(double chi2, int degrees_of_freedom);

}  // namespace petal
