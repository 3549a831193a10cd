// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <gtest/gtest.h>
#include <mrpt/img/TCamera.h>

#include <Eigen/Core>
#include <algorithm>
#include <fstream>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgcodecs.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "petal/calibration/boards.hpp"
#include "real_data.hpp"

namespace petal::testing {

/// A photo of the authors' scenes, and where its corners are said to be.
struct RealScene {
    cv::Mat pixels;
    mrpt::img::TCamera camera;
    std::vector<Eigen::Vector2d> reference;
};

/// Written with a point, whatever the locale of the process.
inline double written_number(const std::string& text) {
    std::istringstream in(text);
    in.imbue(std::locale::classic());
    double value = 0.0;
    in >> value;
    EXPECT_TRUE(in) << text;
    return value;
}

/// Columns 3 and 4 (from 0) of a CSV file.
inline std::vector<Eigen::Vector2d> reference_pixels(const std::filesystem::path& file) {
    std::vector<Eigen::Vector2d> pixels;
    std::ifstream in(file);
    for (std::string line; std::getline(in, line);) {
        if (line.empty() || line[0] == '#') continue;
        std::stringstream cells(line);
        std::vector<std::string> cell;
        for (std::string text; std::getline(cells, text, ',');) cell.push_back(text);
        pixels.emplace_back(written_number(cell.at(3)), written_number(cell.at(4)));
    }
    return pixels;
}

inline RealScene read_scene(const std::string& name, const std::string& reference) {
    RealScene scene;
    scene.pixels = cv::imread((real_data() / name / "image.jpg").string());
    scene.camera.ncols = static_cast<std::uint32_t>(scene.pixels.cols);
    scene.camera.nrows = static_cast<std::uint32_t>(scene.pixels.rows);
    scene.reference = reference_pixels(real_data() / name / reference);
    return scene;
}

inline RealScene campus_scene() {
    RealScene scene = read_scene("sjtu_campus", "reference_corners_image.csv");
    scene.camera.setIntrinsicParamsFromValues(920.52948, 920.92645, 645.0882, 358.04642);
    scene.camera.setDistortionPlumbBob(-0.00633318, 0.00222445, -0.00020834, -0.00099644, 0.0);
    return scene;
}

inline RealScene indoor_scene() {
    RealScene scene = read_scene("sjtu_indoor", "published_corner_pairs.csv");
    scene.camera.setIntrinsicParamsFromValues(349.778091, 349.067100, 315.445567, 279.04059);
    scene.camera.setDistortionPlumbBob(-0.00633318, 0.00222445, -0.00020834, -0.00099644, 0.0);
    return scene;
}

inline std::vector<Eigen::Vector2d> all_corners(const ImageBoards& boards) {
    std::vector<Eigen::Vector2d> corners;
    for (const auto& board : boards.boards)
        corners.insert(corners.end(), board.corners.begin(), board.corners.end());
    return corners;
}

/// For each reference point the distance of the nearest corner, ascending.
inline std::vector<double> distances_to_nearest(const std::vector<Eigen::Vector2d>& reference,
                                                const std::vector<Eigen::Vector2d>& corners) {
    std::vector<double> all;
    for (const auto& point : reference) {
        double nearest = 1e9;
        for (const auto& corner : corners) nearest = std::min(nearest, (corner - point).norm());
        all.push_back(nearest);
    }
    std::sort(all.begin(), all.end());
    return all;
}

inline double median_of_sorted(const std::vector<double>& sorted) {
    return sorted.at(sorted.size() / 2);
}

/// Corners of the indoor photo in the picture that the published ones belong to: its authors
/// rectified it with a new camera matrix (all pixels kept) and took the corners there.
inline std::vector<Eigen::Vector2d> in_published_picture(
    const RealScene& scene, const std::vector<Eigen::Vector2d>& corners) {
    cv::Mat k = (cv::Mat_<double>(3, 3) << scene.camera.fx(), 0, scene.camera.cx(), 0,
                 scene.camera.fy(), scene.camera.cy(), 0, 0, 1);
    cv::Mat d = (cv::Mat_<double>(1, 4) << -0.00633318, 0.00222445, -0.00020834, -0.00099644);
    const cv::Mat rectified = cv::getOptimalNewCameraMatrix(k, d, scene.pixels.size(), 1.0);
    std::vector<cv::Point2d> raw, moved;
    for (const auto& c : corners) raw.emplace_back(c.x(), c.y());
    cv::undistortPoints(raw, moved, k, d, cv::noArray(), rectified);
    std::vector<Eigen::Vector2d> in_theirs;
    for (const auto& p : moved) in_theirs.emplace_back(p.x, p.y);
    return in_theirs;
}

}  // namespace petal::testing
