// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "petal/error.hpp"
#include "sinks/detail/export_format.hpp"

namespace petal {
namespace {

using mrpt::img::DistortionModel;

/// Kalibr and FAST-LIVO2 know k1 k2 p1 p2 alone.
bool four_coefficients(const mrpt::img::TCamera& model) {
    return model.distortion != DistortionModel::plumb_bob || distortion_of(model).size() == 4;
}

std::string no_model(const ExportCamera& camera, const char* format) {
    return std::string(format) + ": the intrinsics of camera '" + camera.camera +
           (camera.model ? "' have a k3 or more, which the format does not know"
                         : "' are not known: wire images");
}

std::string matrix_rows(const Eigen::Isometry3d& pose) {
    std::string text;
    for (Eigen::Index r = 0; r < 4; ++r)
        text += "  - [" + fixed9_list(row_major(pose.matrix().row(r))) + "]\n";
    return text;
}

std::string kalibr_model(const mrpt::img::TCamera& model) {
    const bool fisheye = model.distortion == DistortionModel::kannala_brandt;
    const bool none = model.distortion == DistortionModel::none;
    std::string text = "  camera_model: pinhole\n  intrinsics: [" +
                       fixed9_list({model.fx(), model.fy(), model.cx(), model.cy()}) + "]\n";
    text += std::string("  distortion_model: ") +
            (none      ? "none"
             : fisheye ? "equidistant"
                       : "radtan") +
            "\n  distortion_coeffs: [" + (none ? "" : fixed9_list(distortion_of(model))) + "]\n";
    return text + "  resolution: [" + std::to_string(model.ncols) + ", " +
           std::to_string(model.nrows) + "]\n";
}

}  // namespace

ExportText export_kalibr(const ExportInput& input) {
    ExportText result;
    std::vector<std::string> head = export_head(input);
    head.emplace_back("");
    head.emplace_back("camchain.yaml of Kalibr; camera frames are optical ones.");
    head.emplace_back(
        "T_cam_lidar: p_cam = T p_lidar, 4 x 4 row by row. Kalibr itself passes over it.");
    head.emplace_back("T_cn_cnm1: p_this = T p_camera_before.");
    head.emplace_back("intrinsics: fu fv pu pv; pixel (0, 0) is the centre of the top-left one.");
    for (std::size_t i = 0; i < input.cameras.size(); ++i) {
        const ExportCamera& each = input.cameras[i];
        result.text += "cam" + std::to_string(i) + ":\n  # camera " + yaml_text(each.camera) +
                       ", LiDAR " + yaml_text(each.lidar) + "\n";
        if (each.model && four_coefficients(*each.model)) {
            result.text += kalibr_model(*each.model);
        } else {
            result.left_out.push_back(no_model(each, "kalibr"));
            result.text += "  # Intrinsics are left out. " + result.left_out.back() + "\n";
        }
        result.text += "  T_cam_lidar:\n" + matrix_rows(each.T_camera_lidar);
        if (i == 0) continue;
        const ExportCamera& before = input.cameras[i - 1];
        if (before.lidar == each.lidar)
            result.text += "  T_cn_cnm1:\n" +
                           matrix_rows(each.T_camera_lidar * before.T_camera_lidar.inverse());
        else
            result.left_out.push_back("kalibr: cameras '" + before.camera + "' and '" +
                                      each.camera + "' hang on different LiDARs: no T_cn_cnm1");
    }
    result.text = comment(head) + result.text;
    return result;
}

ExportText export_fast_livo2(const ExportInput& input) {
    if (input.cameras.size() != 1) throw Error("FAST-LIVO2 has one camera to a file");
    const ExportCamera& each = input.cameras.front();
    ExportText result;
    std::vector<std::string> head = export_head(input);
    head.emplace_back("");
    head.emplace_back("FAST-LIVO2: p_camera = Rcl p_lidar + Pcl, Rcl row by row, Pcl in m.");
    head.emplace_back("extrinsic_T and extrinsic_R (LiDAR to IMU) are not petal's: keep your own.");
    head.emplace_back(
        "The camera block belongs in the camera's file (camera_pinhole.yaml and the like);");
    head.emplace_back(
        "`scale` there is FAST-LIVO2's own: how much the photo is shrunk for tracking.");
    result.text = comment(head) + "extrin_calib:\n  Rcl: [";
    for (Eigen::Index r = 0; r < 3; ++r)
        result.text += (r > 0 ? ",\n        " : "") +
                       fixed9_list(row_major(each.T_camera_lidar.linear().row(r)));
    result.text +=
        "]\n  Pcl: [" + fixed9_list(row_major(each.T_camera_lidar.translation())) + "]\n\n";
    if (!each.model || !four_coefficients(*each.model)) {
        result.left_out.push_back(no_model(each, "fast_livo2"));
        result.text += "# The camera block is left out. " + result.left_out.back() + "\n";
        return result;
    }
    const mrpt::img::TCamera& model = *each.model;
    const bool fisheye = model.distortion == DistortionModel::kannala_brandt;
    result.text += std::string("cam_model: ") + (fisheye ? "EquidistantCamera" : "Pinhole") +
                   "\ncam_width: " + std::to_string(model.ncols) +
                   "\ncam_height: " + std::to_string(model.nrows) + "\nscale: 1.0\n";
    const std::pair<const char*, double> focal[] = {{"cam_fx", model.fx()},
                                                    {"cam_fy", model.fy()},
                                                    {"cam_cx", model.cx()},
                                                    {"cam_cy", model.cy()}};
    for (const auto& [key, value] : focal)
        result.text += std::string(key) + ": " + fixed9(value) + "\n";
    const std::vector<double> distortion = distortion_of(model);
    for (std::size_t i = 0; i < distortion.size(); ++i)
        result.text += (fisheye ? "k" + std::to_string(i + 1) : "cam_d" + std::to_string(i)) +
                       ": " + fixed9(distortion[i]) + "\n";
    return result;
}

}  // namespace petal
