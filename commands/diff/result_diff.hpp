// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "petal/calibration/extrinsics.hpp"

namespace petal {

/// What another pose does to the pixel of a point straight ahead of the camera.
struct PixelShift {
    double range = 0.0;     ///< m
    double px = 0.0;        ///< from the pose of A to that of B
    double sigma_px = 0.0;  ///< its largest 1 sigma, from both covariances
};

/// Two poses T_camera_lidar of one camera and LiDAR: T_B = Exp((rho, phi)) T_A.
struct PoseDifference {
    std::string camera, lidar;
    Eigen::Vector3d translation = Eigen::Vector3d::Zero();  ///< t_B - t_A, m, the camera's axes
    Eigen::Vector3d rotation = Eigen::Vector3d::Zero();     ///< phi, rad, the camera's axes
    /// 1 sigma of these, the covariances of A and B taken as independent and added.
    Eigen::Vector3d sigma_translation = Eigen::Vector3d::Zero();
    Eigen::Vector3d sigma_rotation = Eigen::Vector3d::Zero();
    /// (rho, phi)' (covariance A + covariance B)^-1 (rho, phi); chi-square with 6 degrees of
    /// freedom where both are right. None where the sum cannot be inverted.
    std::optional<double> mahalanobis_squared;
    double probability = 0.0;  ///< of a larger one by chance
    double focal_px = 0.0;     ///< for `pixels`; 0 where it is not known
    std::vector<PixelShift> pixels = {};
};

/// A number that both results tell, or one alone.
struct FigureDifference {
    std::string name;
    std::optional<double> a, b;
};

struct ResultDifference {
    struct Side {
        std::string verdict;
        std::vector<std::string> reasons;
    };
    Side a, b;
    std::vector<PoseDifference> poses;
    std::vector<std::string> only_a, only_b;  ///< "camera 'X' and LiDAR 'Y'"
    std::vector<FigureDifference> figures;    ///< those that differ

    /// Both have the same sensors, and no pose differs more than its covariances explain:
    /// chi-square within its 99.9 % band.
    bool agree() const;
};

/// `focal_px` is used for the pixels where positive; else the focal length that the corners of A
/// (or B) tell, where there are some. \throws Error naming the file: no result, nothing solved.
ResultDifference compare_results(const std::filesystem::path& a, const std::filesystem::path& b,
                                 double focal_px = 0.0);

/// For people; and for programs, without rounding.
std::string difference_table(const ResultDifference& difference);
std::string difference_json(const ResultDifference& difference);

}  // namespace petal
