// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include <opencv2/core.hpp>
#include <set>

#include "petal/calibration/angles.hpp"
#include "petal/calibration/file_name.hpp"
#include "petal/error.hpp"
#include "sinks/detail/export_format.hpp"

namespace petal {
namespace {

cv::Mat mat_of(const Eigen::MatrixXd& matrix) {
    return cv::Mat(row_major(matrix), true).reshape(1, static_cast<int>(matrix.rows()));
}

void write_opencv_camera(cv::FileStorage& file, const ExportCamera& each) {
    const Eigen::AngleAxisd turn(each.T_camera_lidar.linear());
    // By write(): the stream would take a label that begins with a bracket for structure.
    file.write("camera", each.camera);
    file.write("lidar", each.lidar);
    file << "T_camera_lidar" << mat_of(each.T_camera_lidar.matrix());
    file << "T_lidar_camera" << mat_of(each.T_camera_lidar.inverse().matrix());
    file << "rvec" << mat_of(turn.angle() * turn.axis());
    file << "tvec" << mat_of(each.T_camera_lidar.translation());
    if (!each.model) return;
    const mrpt::img::TCamera& model = *each.model;
    const bool fisheye = model.distortion == mrpt::img::DistortionModel::kannala_brandt;
    file << "image_width" << static_cast<int>(model.ncols);
    file << "image_height" << static_cast<int>(model.nrows);
    Eigen::Matrix3d K = Eigen::Matrix3d::Identity();
    K << model.fx(), 0.0, model.cx(), 0.0, model.fy(), model.cy(), 0.0, 0.0, 1.0;
    file << "camera_matrix" << mat_of(K);
    file << "distortion_model" << (fisheye ? "fisheye" : "plumb_bob");
    file << "distortion_coefficients" << cv::Mat(distortion_of(model), true);
}

/// [x y z yaw pitch roll], m and deg.
std::string mrpt_pose(const Eigen::Isometry3d& pose) {
    const Eigen::Vector3d angles = roll_pitch_yaw(pose.linear()) * kDegrees;
    const Eigen::Vector3d t = pose.translation();
    return "[" + fixed9_list({t.x(), t.y(), t.z(), angles[2], angles[1], angles[0]}, " ") + "]";
}

std::string mrpt_model(const mrpt::img::TCamera& model) {
    using mrpt::img::DistortionModel;
    const bool fisheye = model.distortion == DistortionModel::kannala_brandt;
    std::vector<double> distortion = distortion_of(model);
    distortion.resize(fisheye ? 4 : distortion.size() > 5 ? 8 : 5, 0.0);
    std::string text =
        "resolution = [" + std::to_string(model.ncols) + " " + std::to_string(model.nrows) + "]\n";
    text += "fx = " + fixed9(model.fx()) + "\nfy = " + fixed9(model.fy()) +
            "\ncx = " + fixed9(model.cx()) + "\ncy = " + fixed9(model.cy()) + "\n";
    return text + "dist = [" + fixed9_list(distortion, " ") + "]\ndistortion_model = " +
           (fisheye                                          ? "kannala_brandt"
            : model.distortion == DistortionModel::plumb_bob ? "plumb_bob"
                                                             : "none") +
           "\n";
}

}  // namespace

ExportText export_opencv(const ExportInput& input) {
    ExportText result;
    cv::FileStorage file(".yaml", cv::FileStorage::WRITE | cv::FileStorage::MEMORY);
    std::vector<std::string> head = export_head(input);
    head.emplace_back("");
    head.emplace_back(
        "OpenCV. T_camera_lidar: p_camera = T p_lidar, 4 x 4. rvec and tvec are the same pose,");
    head.emplace_back(
        "as cv::projectPoints takes it for points in the LiDAR frame. Camera frames are");
    head.emplace_back("optical ones; pixel (0, 0) is the centre of the top-left one.");
    for (const std::string& line : head)
        file.writeComment(line.empty() ? std::string(" ") : line, false);
    file << "cameras"
         << "[";
    for (const ExportCamera& each : input.cameras) {
        file << "{";
        write_opencv_camera(file, each);
        file << "}";
        if (!each.model)
            result.left_out.push_back("opencv: the intrinsics of camera '" + each.camera +
                                      "' are not known: wire images");
    }
    file << "]";
    result.text = file.releaseAndGetString();
    return result;
}

ExportText export_mrpt(const ExportInput& input) {
    ExportText result;
    std::vector<std::string> head = export_head(input);
    head.emplace_back("");
    head.emplace_back(
        "MRPT, by mrpt::config::CConfigFile. Poses as CPose3D::FromString reads them:");
    head.emplace_back("[x y z yaw pitch roll], m and degrees, R = Rz(yaw) Ry(pitch) Rx(roll).");
    head.emplace_back(
        "camera_on_lidar: T_lidar_camera, the camera's pose in the LiDAR's frame: the");
    head.emplace_back(
        "cameraPose of a CObservationImage where the LiDAR's sensorPose is none. Optical frame.");
    head.emplace_back(
        "lidar_on_camera: T_camera_lidar. The rest: as TCamera::loadFromConfigFile reads it.");
    result.text = comment(head, "; ");
    std::set<std::string> taken;
    for (const ExportCamera& each : input.cameras) {
        std::string section = file_name(each.camera);  // free text may hold brackets
        if (!taken.insert(section).second) section += "_" + file_name(each.lidar);
        result.text += "\n[" + section + "]\nlidar = " + file_name(each.lidar) +
                       "\ncamera_on_lidar = " + mrpt_pose(each.T_camera_lidar.inverse()) +
                       "\nlidar_on_camera = " + mrpt_pose(each.T_camera_lidar) + "\n";
        if (each.model)
            result.text += mrpt_model(*each.model);
        else
            result.left_out.push_back("mrpt: the intrinsics of camera '" + each.camera +
                                      "' are not known: wire images");
    }
    return result;
}

}  // namespace petal
