// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <mrpt/img/TCamera.h>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "petal/calibration/correspondences.hpp"

namespace petal::testing {

/// Every number of a text file, line by line; lines without one (comments, headings) are left out.
inline std::vector<std::vector<double>> number_rows(const std::filesystem::path& file) {
    std::ifstream in(file);
    if (!in) throw std::runtime_error("cannot read " + file.string());
    std::vector<std::vector<double>> rows;
    for (std::string line; std::getline(in, line);) {
        if (line.empty() || line[0] == '#') continue;
        std::replace(line.begin(), line.end(), ',', ' ');
        std::istringstream words(line);
        words.imbue(std::locale::classic());
        std::vector<double> row;
        for (double value; words >> value;) row.push_back(value);
        if (!row.empty()) rows.push_back(row);
    }
    return rows;
}

/// The published T_camera_lidar: the last four rows of four numbers of the file.
inline Eigen::Isometry3d published_pose(const std::filesystem::path& file) {
    auto rows = number_rows(file);
    rows.erase(rows.begin(), rows.end() - 4);
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 4; ++j)
            pose.matrix()(i, j) = rows[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)];
    // Six digits are printed: back onto SO(3).
    pose.linear() = Eigen::Quaterniond(pose.linear()).normalized().toRotationMatrix();
    return pose;
}

inline mrpt::img::TCamera camera_of(double fx, double fy, double cx, double cy, unsigned cols,
                                    unsigned rows) {
    mrpt::img::TCamera camera;
    camera.setIntrinsicParamsFromValues(fx, fy, cx, cy);
    camera.ncols = cols;
    camera.nrows = rows;
    return camera;
}

/// The intrinsics of intrinsics.yaml, without distortion.
inline mrpt::img::TCamera indoor_camera() {
    return camera_of(349.77809149183855, 349.06710043680147, 315.4455672812897, 279.0405899012457,
                     640, 540);
}
/// The intrinsics of intrinsics.txt, without distortion.
inline mrpt::img::TCamera campus_camera() {
    return camera_of(920.52948, 920.9264526367, 645.0881958, 358.0464172363, 1280, 720);
}

/// The 64 pairs, 16 a board (board 0 to 3), as the file has them.
inline std::vector<PointPair> indoor_pairs(const std::filesystem::path& data) {
    std::vector<PointPair> pairs;
    for (const auto& row : number_rows(data / "sjtu_indoor/published_corner_pairs.csv")) {
        PointPair pair;
        pair.lidar = Eigen::Vector3d(row[0], row[1], row[2]);
        pair.image = Eigen::Vector2d(row[3], row[4]);
        pair.board = static_cast<int>(pairs.size() / 16);
        pair.corner = static_cast<int>(pairs.size() % 16);
        pairs.push_back(pair);
    }
    return pairs;
}

/// The 42 pairs: ten single points, then two boards of 16.
inline std::vector<PointPair> campus_pairs(const std::filesystem::path& data) {
    const auto points = number_rows(data / "sjtu_campus/published_corners_lidar.txt");
    const auto pixels = number_rows(data / "sjtu_campus/published_corners_image.txt");
    std::vector<PointPair> pairs;
    for (std::size_t i = 0; i < points.size(); ++i) {
        PointPair pair;
        pair.lidar = Eigen::Vector3d(points[i][0], points[i][1], points[i][2]);
        pair.image = Eigen::Vector2d(pixels[i][0], pixels[i][1]);
        if (i >= 10) {
            pair.board = static_cast<int>((i - 10) / 16);
            pair.corner = static_cast<int>((i - 10) % 16);
        }
        pairs.push_back(pair);
    }
    return pairs;
}

/// The pairs of one board, sorted row by row from the top left by where they lie in the image.
inline std::vector<PointPair> board_in_rows(const std::vector<PointPair>& pairs, int board) {
    std::vector<PointPair> corners;
    for (const PointPair& pair : pairs)
        if (pair.board == board) corners.push_back(pair);
    std::stable_sort(corners.begin(), corners.end(), [](const PointPair& a, const PointPair& b) {
        return a.image.y() < b.image.y();
    });
    for (auto row = corners.begin(); row != corners.end(); row += 4)
        std::stable_sort(row, row + 4, [](const PointPair& a, const PointPair& b) {
            return a.image.x() < b.image.x();
        });
    for (std::size_t i = 0; i < corners.size(); ++i) corners[i].corner = static_cast<int>(i);
    return corners;
}

}  // namespace petal::testing
