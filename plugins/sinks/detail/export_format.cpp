// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "sinks/detail/export_format.hpp"

#include <array>
#include <charconv>
#include <cmath>

#include "petal/error.hpp"
#include "sinks/detail/result_json.hpp"

namespace petal {
namespace {

std::string pose_line(const Eigen::Isometry3d& pose) {
    const Eigen::Quaterniond q(pose.linear());
    return "translation (m) x y z = [" +
           fixed9_list({pose.translation().x(), pose.translation().y(), pose.translation().z()}) +
           "], quaternion x y z w = [" + fixed9_list({q.x(), q.y(), q.z(), q.w()}) + "]";
}

/// Line breaks would end the comment.
std::string one_line(std::string text) {
    for (char& c : text)
        if (static_cast<unsigned char>(c) < ' ') c = ' ';
    return text;
}

}  // namespace

std::string fixed9(double value) {
    std::array<char, 400> text{};  // 309 digits before the point at most
    const auto end =
        std::to_chars(text.data(), text.data() + text.size(), value, std::chars_format::fixed, 9);
    std::string result(text.data(), end.ptr);
    return result == "-0.000000000" ? "0.000000000" : result;
}

std::string fixed9_list(const std::vector<double>& values, const std::string& separator) {
    std::string text;
    for (const double value : values) text += (text.empty() ? "" : separator) + fixed9(value);
    return text;
}

std::vector<double> row_major(const Eigen::MatrixXd& matrix) {
    std::vector<double> values;
    for (Eigen::Index r = 0; r < matrix.rows(); ++r)
        for (Eigen::Index c = 0; c < matrix.cols(); ++c) values.push_back(matrix(r, c));
    return values;
}

Eigen::Vector3d roll_pitch_yaw(const Eigen::Matrix3d& rotation) {
    const double yaw = std::atan2(rotation(1, 0), rotation(0, 0));
    const double pitch = std::atan2(-rotation(2, 0), std::hypot(rotation(0, 0), rotation(1, 0)));
    // From what the two others leave: yaw is arbitrary near the right angle, their sum is not.
    const Eigen::Matrix3d rest = (Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()) *
                                  Eigen::AngleAxisd(pitch, Eigen::Vector3d::UnitY()))
                                     .toRotationMatrix()
                                     .transpose() *
                                 rotation;
    return {std::atan2(rest(2, 1), rest(1, 1)), pitch, yaw};
}

std::string yaml_text(const std::string& text) {
    std::string quoted = "\"";
    for (const char c : one_line(text)) {
        if (c == '"' || c == '\\') quoted += '\\';
        quoted += c;
    }
    return quoted + "\"";
}

std::vector<std::string> export_head(const ExportInput& input) {
    std::vector<std::string> lines{"Extrinsics by petal."};
    if (input.level != Level::usable) {
        lines.push_back(std::string("VERDICT: ") + to_string(input.level) + ". Why:");
        for (const std::string& reason : input.reasons) lines.push_back("- " + one_line(reason));
    }
    for (const ExportCamera& each : input.cameras) {
        const std::string camera = one_line(each.camera);
        const std::string lidar = one_line(each.lidar);
        lines.push_back("Camera '" + camera + "' (optical frame " + one_line(each.camera_frame) +
                        ": x right, y down, z forward) and LiDAR '" + lidar + "' (frame " +
                        one_line(each.lidar_frame) + ", the sensor's own):");
        lines.push_back("T_camera_lidar, p_camera = R p_lidar + t: " +
                        pose_line(each.T_camera_lidar));
        lines.push_back("T_lidar_camera, p_lidar = R p_camera + t: " +
                        pose_line(each.T_camera_lidar.inverse()));
        lines.push_back(placement_sentence(each.T_camera_lidar));
    }
    return lines;
}

std::string comment(const std::vector<std::string>& lines, const std::string& mark) {
    std::string text;
    for (const std::string& line : lines) text += mark + line + "\n";
    return text;
}

std::vector<double> distortion_of(const mrpt::img::TCamera& model) {
    const std::array<double, 8>& d = model.dist;
    if (model.distortion == mrpt::img::DistortionModel::kannala_brandt)
        return {model.k1(), model.k2(), model.k3(), model.k4()};
    if (model.distortion == mrpt::img::DistortionModel::none) return {0.0, 0.0, 0.0, 0.0};
    std::vector<double> values(d.begin(), d.end());
    // OpenCV takes 4, 5 or 8 numbers.
    if (d[5] == 0.0 && d[6] == 0.0 && d[7] == 0.0) values.resize(d[4] == 0.0 ? 4 : 5);
    return values;
}

}  // namespace petal
