// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "photo.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <random>
#include <vector>

#include "petal/calibration/camera_model.hpp"
#include "petal/error.hpp"

namespace petal::synthetic {

namespace {

constexpr int kSupersampling = 6;
constexpr int kShift = 4;           // fixed-point bits of OpenCV's polygon filling
constexpr int kPointsPerSide = 24;  // straight sides are curves under distortion

/// A polygon of a board as the supersampled picture sees it.
std::vector<cv::Point> seen(const Scene& scene, const CameraModel& model,
                            const Eigen::Isometry3d& T_lidar_board,
                            const std::vector<Eigen::Vector2d>& polygon) {
    std::vector<cv::Point> points;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const Eigen::Vector2d from = polygon[i];
        const Eigen::Vector2d to = polygon[(i + 1) % polygon.size()];
        for (int k = 0; k < kPointsPerSide; ++k) {
            const Eigen::Vector2d on_board =
                from + (to - from) * (static_cast<double>(k) / kPointsPerSide);
            const auto pixel = model.project(scene.T_camera_lidar * T_lidar_board *
                                             Eigen::Vector3d(on_board.x(), on_board.y(), 0.0));
            if (!pixel)
                throw Error("a board of the synthetic scene lies outside the camera's view");
            const auto fixed = [](double value) {
                const double fine = (value + 0.5) * kSupersampling - 0.5;
                return static_cast<int>(std::lround(fine * (1 << kShift)));
            };
            points.emplace_back(fixed(pixel->x()), fixed(pixel->y()));
        }
    }
    return points;
}

void fill(cv::Mat& picture, const std::vector<cv::Point>& polygon, double grey) {
    cv::fillPoly(picture, std::vector<std::vector<cv::Point>>{polygon}, cv::Scalar::all(grey),
                 cv::LINE_8, kShift);
}

/// A dim wall over a floor, with a soft light.
double background(int row, int col, const cv::Mat& picture) {
    const double y = static_cast<double>(row) / picture.rows;
    const double x = static_cast<double>(col) / picture.cols;
    const double wall =
        70.0 + 40.0 * std::exp(-8.0 * ((x - 0.3) * (x - 0.3) + (y - 0.2) * (y - 0.2)));
    return y < 0.8 ? wall : 55.0 - 20.0 * (y - 0.8);
}

}  // namespace

cv::Mat take_photo(const Scene& scene, std::uint64_t seed) {
    const CameraModel model(scene.camera);
    cv::Mat fine(static_cast<int>(scene.camera.nrows) * kSupersampling,
                 static_cast<int>(scene.camera.ncols) * kSupersampling, CV_8U);
    for (int r = 0; r < fine.rows; ++r)
        for (int c = 0; c < fine.cols; ++c)
            fine.at<std::uint8_t>(r, c) = static_cast<std::uint8_t>(background(r, c, fine));
    double grey = 205.0;
    for (const Eigen::Isometry3d& board : scene.T_lidar_board) {
        fill(fine, seen(scene, model, board, scene.target.outline), grey);
        for (const auto& hole : scene.target.holes)
            fill(fine, seen(scene, model, board, hole), 45.0);
        grey -= 12.0;  // no two boards are lit alike
    }
    cv::Mat photo;
    cv::resize(fine, photo, cv::Size(), 1.0 / kSupersampling, 1.0 / kSupersampling, cv::INTER_AREA);
    cv::GaussianBlur(photo, photo, cv::Size(), 0.7);
    std::mt19937_64 random(seed);
    std::normal_distribution<double> noise(0.0, 2.5);
    for (int r = 0; r < photo.rows; ++r)
        for (int c = 0; c < photo.cols; ++c) {
            const double value = photo.at<std::uint8_t>(r, c) + noise(random);
            photo.at<std::uint8_t>(r, c) =
                static_cast<std::uint8_t>(std::clamp(std::lround(value), 0L, 255L));
        }
    return photo;
}

}  // namespace petal::synthetic
