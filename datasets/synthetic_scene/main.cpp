// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include <CLI/CLI.hpp>
#include <filesystem>
#include <iostream>
#include <opencv2/imgcodecs.hpp>
#include <sstream>

#include "margin_points.hpp"
#include "petal/calibration/camera_model.hpp"
#include "petal/calibration/truth_json.hpp"
#include "petal/error.hpp"
#include "petal/output.hpp"
#include "photo.hpp"
#include "scene.hpp"

namespace {

namespace fs = std::filesystem;
using petal::synthetic::Scene;

std::ostringstream plain_text() {
    std::ostringstream text;
    text.imbue(std::locale::classic());
    return text;
}

std::string intrinsics_yaml(const Scene& scene) {
    auto text = plain_text();
    const auto& camera = scene.camera;
    text << "%YAML:1.0\n---\nimage_width: " << camera.ncols << "\nimage_height: " << camera.nrows
         << "\ncamera_matrix: !!opencv-matrix\n   rows: 3\n   cols: 3\n   dt: d\n   data: [ "
         << camera.fx() << ", 0., " << camera.cx() << ", 0., " << camera.fy() << ", " << camera.cy()
         << ", 0., 0., 1. ]\ndistortion_coefficients: !!opencv-matrix\n   rows: 5\n   cols: 1\n   "
            "dt: d\n   data: [ "
         << camera.k1() << ", " << camera.k2() << ", " << camera.p1() << ", " << camera.p2() << ", "
         << camera.k3() << " ]\n";
    return text.str();
}

std::string cloud_csv(const std::vector<Eigen::Vector3d>& points) {
    auto text = plain_text();
    text << "# x,y,z in metres, LiDAR frame: synthetic edge points of four boards, and clutter\n";
    text.precision(3);
    text << std::fixed;
    for (const Eigen::Vector3d& p : points) text << p.x() << "," << p.y() << "," << p.z() << "\n";
    return text.str();
}

petal::Truth truth_of(const Scene& scene) {
    const petal::CameraModel model(scene.camera);
    petal::Truth truth;
    truth.T_camera_lidar = scene.T_camera_lidar;
    for (const Eigen::Isometry3d& pose : scene.T_lidar_board) {
        petal::Truth::Board board;
        board.target = scene.target.name;
        board.T_lidar_board = pose;
        for (const Eigen::Vector2d& corner : scene.target.corners()) {
            board.corners_lidar.push_back(pose * Eigen::Vector3d(corner.x(), corner.y(), 0.0));
            board.corners_image.push_back(
                model.project(scene.T_camera_lidar * board.corners_lidar.back()).value());
        }
        truth.boards.push_back(std::move(board));
    }
    return truth;
}

void put(const fs::path& path, const std::string& content) {
    petal::PendingFile file(path);
    petal::write_file(file.path(), content);
    file.commit();
}

}  // namespace

int main(int argc, char** argv) {
    CLI::App app(
        "writes a synthetic scene with known extrinsics: photo, intrinsics, LiDAR edge points");
    std::string folder;
    std::uint64_t seed = 1;
    app.add_option("FOLDER", folder, "where to write it")->required();
    app.add_option("--seed", seed, "seed of the noise");
    CLI11_PARSE(app, argc, argv);
    try {
        const Scene scene = petal::synthetic::make_scene();
        petal::PendingFile photo(fs::path(folder) / "image.jpg");
        if (!cv::imwrite(photo.path().string(), petal::synthetic::take_photo(scene, seed)))
            throw petal::Error("cannot write " + photo.path().string());
        photo.commit();
        put(fs::path(folder) / "intrinsics.yaml", intrinsics_yaml(scene));
        put(fs::path(folder) / "lidar_margin_points.csv",
            cloud_csv(petal::synthetic::margin_points(scene, seed)));
        petal::PendingFile truth(fs::path(folder) / "truth.json");
        petal::write_truth_json(truth_of(scene), truth.path());
        truth.commit();
    } catch (const std::exception& failure) {
        std::cerr << "petal_synthetic_scene: " << failure.what() << "\n";
        return 1;
    }
    return 0;
}
