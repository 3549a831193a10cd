// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <mrpt/img/TCamera.h>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <optional>
#include <string>
#include <vector>

#include "petal/run.hpp"

namespace petal {

/// One camera as other programs are told of it. Its frame is the optical one: x right, y down, z
/// forward.
struct ExportCamera {
    std::string camera, lidar;              ///< labels
    std::string camera_frame, lidar_frame;  ///< what others call those frames
    Eigen::Isometry3d T_camera_lidar = Eigen::Isometry3d::Identity();
    std::optional<mrpt::img::TCamera> model = {};  ///< none where nobody told the intrinsics
};

struct ExportInput {
    std::vector<ExportCamera> cameras;
    Level level = Level::usable;
    std::vector<std::string> reasons;
    bool lidar_is_parent = true;  ///< in formats of parents and children
};

/// What a format makes of it.
struct ExportText {
    std::string text;
    std::vector<std::string> left_out = {};  ///< what the format has no words for, or nobody told
};

// The formats. Each text tells at its head what the frames are, both directions, and the verdict
// where it is not usable.
ExportText export_ros1(const ExportInput& input);        ///< a launch file with tf2_ros
ExportText export_ros2(const ExportInput& input);        ///< the same for ROS 2, in XML
ExportText export_autoware(const ExportInput& input);    ///< sensor_kit_calibration.yaml
ExportText export_kalibr(const ExportInput& input);      ///< camchain.yaml
ExportText export_fast_livo2(const ExportInput& input);  ///< Rcl, Pcl and camera; of one camera
ExportText export_opencv(const ExportInput& input);      ///< cv::FileStorage, YAML
ExportText export_mrpt(const ExportInput& input);        ///< INI for mrpt::config::CConfigFile

/// With nine decimals, whatever the locale: to the nanometre, and never without a point (readers of
/// YAML take "1e-05" for text and "1" for an integer).
std::string fixed9(double value);
/// Numbers with a separator between.
std::string fixed9_list(const std::vector<double>& values, const std::string& separator = ", ");
/// Row by row.
std::vector<double> row_major(const Eigen::MatrixXd& matrix);
/// Angles of R = Rz(yaw) Ry(pitch) Rx(roll), rad, also where pitch is a right angle: roll, pitch,
/// yaw.
Eigen::Vector3d roll_pitch_yaw(const Eigen::Matrix3d& rotation);
/// In double quotes, as YAML has it.
std::string yaml_text(const std::string& text);
/// The verdict where it is not usable, then each camera with both directions. Lines without a mark
/// of comments; none holds a line break.
std::vector<std::string> export_head(const ExportInput& input);
/// Each line behind `mark`.
std::string comment(const std::vector<std::string>& lines, const std::string& mark = "# ");
/// The distortion as OpenCV orders it: of kannala_brandt k1 k2 k3 k4, else k1 k2 p1 p2 k3 k4 k5 k6
/// without zeros at the end, at least four.
std::vector<double> distortion_of(const mrpt::img::TCamera& model);

}  // namespace petal
