// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <mrpt/img/CImage.h>
#include <mrpt/img/TCamera.h>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <random>
#include <string>
#include <vector>

#include "petal/calibration/boards.hpp"
#include "petal/calibration/camera_model.hpp"
#include "petal/calibration/images.hpp"
#include "petal/calibration/target.hpp"
#include "petal/testing/stage_harness.hpp"

namespace petal::testing {

inline mrpt::img::TCamera make_camera(int width, int height, double focal, double k1 = 0.0) {
    mrpt::img::TCamera camera;
    camera.ncols = static_cast<std::uint32_t>(width);
    camera.nrows = static_cast<std::uint32_t>(height);
    camera.setIntrinsicParamsFromValues(focal, focal, 0.5 * (width - 1), 0.5 * (height - 1));
    if (k1 != 0.0) camera.setDistortionPlumbBob(k1, 0.0, 0.0, 0.0, 0.0);
    return camera;
}

/// Board to camera: its centre at `center` (camera frame), facing the camera, then turned about the
/// board's own y (yaw), x (pitch) and normal (roll), degrees.
inline Eigen::Isometry3d board_pose(const Target& target, const Eigen::Vector3d& center,
                                    double yaw_deg, double pitch_deg, double roll_deg = 0.0) {
    const double degree = 0.017453292519943295;
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    pose.translate(center);
    pose.rotate(Eigen::AngleAxisd(yaw_deg * degree, Eigen::Vector3d::UnitY()));
    pose.rotate(Eigen::AngleAxisd(pitch_deg * degree, Eigen::Vector3d::UnitX()));
    pose.rotate(Eigen::AngleAxisd(roll_deg * degree, Eigen::Vector3d::UnitZ()));
    pose.translate(Eigen::Vector3d(-0.5 * target.width(), -0.5 * target.height(), 0.0));
    return pose;
}

inline std::vector<Eigen::Vector2d> true_corners(const Target& target, const CameraModel& camera,
                                                 const Eigen::Isometry3d& pose) {
    std::vector<Eigen::Vector2d> corners;
    for (const auto& c : target.corners())
        corners.push_back(camera.project(pose * Eigen::Vector3d(c.x(), c.y(), 0.0)).value());
    return corners;
}

inline bool in_polygon(const std::vector<Eigen::Vector2d>& polygon, double x, double y) {
    bool in = false;
    for (std::size_t i = 0, j = polygon.size() - 1; i < polygon.size(); j = i++) {
        const auto &a = polygon[i], &b = polygon[j];
        if ((a.y() > y) != (b.y() > y) &&
            x < (b.x() - a.x()) * (y - a.y()) / (b.y() - a.y()) + a.x())
            in = !in;
    }
    return in;
}

/// Root of the mean square of the distances, px.
inline double rms_distance(const std::vector<Eigen::Vector2d>& found,
                           const std::vector<Eigen::Vector2d>& truth) {
    double sum = 0.0;
    for (std::size_t i = 0; i < truth.size(); ++i) sum += (found[i] - truth[i]).squaredNorm();
    return std::sqrt(sum / static_cast<double>(truth.size()));
}

/// What an image detector finds in one photo.
inline ImageBoards boards_in(StageHarness stage, const CameraImage& image) {
    stage.give<Images>("images", Images{{image}});
    stage.fire();
    return stage.out<ImageBoards>("boards");
}

/// A synthetic photo: background, then boards ray by ray (8 x 8 rays a pixel), blur, noise.
class Photo {
   public:
    explicit Photo(const mrpt::img::TCamera& camera, double background = 70.0)
        : model_(camera),
          pixels_(static_cast<int>(camera.nrows), static_cast<int>(camera.ncols), CV_64F) {
        for (int y = 0; y < pixels_.rows; ++y)  // not flat: a wall lit from one side
            for (int x = 0; x < pixels_.cols; ++x)
                pixels_.at<double>(y, x) = background * (0.8 + 0.4 * x / pixels_.cols);
    }

    /// `bright_below`: holes show a bright thing (0.97 of the plate) at y (m) beyond this in
    /// hole 2. `wall`: brightness of the holes' walls over the plate's; 0: a plate without
    /// thickness.
    Photo& add(const Target& target, const Eigen::Isometry3d& pose, double plate = 180.0,
               double bright_below = 1e9, double wall = 0.0) {
        constexpr int kRays = 8;
        const Eigen::Isometry3d to_board = pose.inverse();
        const Eigen::Vector3d eye = to_board.translation();
        cv::Rect box = bounds(target, pose);
        for (int v = box.y; v < box.y + box.height; ++v) {
            for (int u = box.x; u < box.x + box.width; ++u) {
                double sum = 0.0;
                for (int k = 0; k < kRays * kRays; ++k) {
                    const Eigen::Vector2d p(u + (k % kRays + 0.5) / kRays - 0.5,
                                            v + (k / kRays + 0.5) / kRays - 0.5);
                    sum += plate_at(target, to_board, eye, p, plate, bright_below, wall,
                                    pixels_.at<double>(v, u));
                }
                pixels_.at<double>(v, u) = sum / (kRays * kRays);
            }
        }
        return *this;
    }

    /// Anything else: `paint` gets the sharp pixels (CV_64F).
    template <typename Paint>
    Photo& draw(Paint paint) {
        paint(pixels_);
        return *this;
    }

    CameraImage take(double blur_px, double noise, const std::string& label = "CAMERA") const {
        cv::Mat blurred = pixels_.clone();
        if (blur_px > 0.0) cv::GaussianBlur(pixels_, blurred, cv::Size(), blur_px);
        std::mt19937 random(7);
        std::normal_distribution<double> normal(0.0, 1.0);
        for (int y = 0; y < blurred.rows; ++y)
            for (int x = 0; x < blurred.cols; ++x)
                blurred.at<double>(y, x) += noise * normal(random);
        cv::Mat grey;
        blurred.convertTo(grey, CV_8U);
        return wrap(grey, model_.camera(), label);
    }

    static CameraImage wrap(const cv::Mat& pixels, const mrpt::img::TCamera& camera,
                            const std::string& label = "CAMERA") {
        CameraImage image;
        image.label = label;
        image.image = mrpt::img::CImage(pixels, mrpt::img::DEEP_COPY);
        image.camera = camera;
        return image;
    }

   private:
    double plate_at(const Target& target, const Eigen::Isometry3d& to_board,
                    const Eigen::Vector3d& eye, const Eigen::Vector2d& pixel, double plate,
                    double bright_below, double wall, double behind) const {
        const auto ray = model_.unproject(pixel);
        if (!ray) return behind;
        const Eigen::Vector3d direction = to_board.linear() * *ray;
        const double range = -eye.z() / direction.z();
        const Eigen::Vector3d hit = eye + range * direction;
        if (range <= 0.0 || !in_polygon(target.outline, hit.x(), hit.y())) return behind;
        const Eigen::Vector3d back = hit + (target.thickness / direction.z()) * direction;
        for (std::size_t h = 0; h < target.holes.size(); ++h)
            if (in_polygon(target.holes[h], hit.x(), hit.y()))
                return wall > 0.0 && !in_polygon(target.holes[h], back.x(), back.y()) ? wall * plate
                       : h == 2 && hit.y() > bright_below                             ? 0.97 * plate
                                                                                      : behind;
        return plate;
    }

    cv::Rect bounds(const Target& target, const Eigen::Isometry3d& pose) const {
        Eigen::Vector2d low(1e9, 1e9), high(-1e9, -1e9);
        for (const auto& c : target.outline) {
            const Eigen::Vector2d p =
                model_.project(pose * Eigen::Vector3d(c.x(), c.y(), 0.0)).value();
            low = low.cwiseMin(p);
            high = high.cwiseMax(p);
        }
        const cv::Rect box(
            static_cast<int>(std::floor(low.x())) - 20, static_cast<int>(std::floor(low.y())) - 20,
            static_cast<int>(high.x() - low.x()) + 42, static_cast<int>(high.y() - low.y()) + 42);
        return box & cv::Rect(0, 0, pixels_.cols, pixels_.rows);
    }

    CameraModel model_;
    cv::Mat pixels_;
};

}  // namespace petal::testing
