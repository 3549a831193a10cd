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
#include "petal/calibration/correspondences.hpp"
#include "petal/calibration/diagnosis.hpp"
#include "petal/packet.hpp"
#include "petal/run.hpp"

namespace petal {

/// What is left at one pair: measured minus projected, raw pixels.
struct Residual {
    std::uint64_t scene = 0;  ///< frame number
    int board = -1;
    int corner = -1;
    Eigen::Vector2d image = Eigen::Vector2d::Zero();  ///< as measured
    Eigen::Vector2d error_px = Eigen::Vector2d::Zero();
};

/// T_camera_lidar of one camera: p_camera = R p_lidar + t; camera x right, y down, z forward.
struct CameraExtrinsics {
    std::string camera;
    std::string lidar;
    mrpt::img::TCamera model;
    Eigen::Isometry3d T_camera_lidar = Eigen::Isometry3d::Identity();
    /// Of (rho, phi) in T = Exp((rho, phi)) T_estimated: rho x y z (m), phi x y z (rad).
    Matrix6d covariance = Matrix6d::Zero();
    Eigen::Vector3d sigma_translation = Eigen::Vector3d::Zero();  ///< m, of the fourth column of T
    Eigen::Vector3d sigma_rotation = Eigen::Vector3d::Zero();     ///< rad, about the camera's axes
    std::string weakest_direction;                                ///< plain words
    double chi2 = 0.0;
    int degrees_of_freedom = 0;
    std::vector<Residual> residuals;
    OrderDecision order;
    std::optional<Diagnosis> diagnosis = {};  ///< of solvers that look into their result
};

struct Extrinsics {
    std::vector<CameraExtrinsics> cameras;  ///< only the solved ones
    Level level = Level::not_usable;
    std::vector<std::string> reasons;  ///< plain words; why not better than `level`
};

template <>
struct PacketTraits<Extrinsics> {
    static constexpr const char* name = "Extrinsics";
    static void seal(Extrinsics& extrinsics);
    static std::size_t bytes(const Extrinsics& extrinsics);
};

}  // namespace petal
