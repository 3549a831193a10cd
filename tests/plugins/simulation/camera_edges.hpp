// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <Eigen/Core>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include "petal/calibration/camera_model.hpp"

namespace petal::simulation {

/// The mean of the three channels, float.
inline cv::Mat grey_of(const cv::Mat& image) {
    cv::Mat grey;
    cv::transform(image, grey, cv::Matx13f(1.0F / 3, 1.0F / 3, 1.0F / 3));
    grey.convertTo(grey, CV_32F);
    return grey;
}

/// Along one line of pixels across an edge: the edge's place from the sum of the values between two
/// plateaus. A pixel is the mean over its area and a symmetric blur moves no light, so the sum is
/// exact for straight edges whatever the phase, unlike a level's crossing.
inline double edge_along(const cv::Mat& image, bool along_x, int line, int near_place) {
    constexpr int kCore = 3;     // px to both sides that the edge, blurred and askew, keeps to
    constexpr int kPlateau = 5;  // px beyond them
    const auto value = [&](int at) {
        return static_cast<double>(along_x ? image.at<float>(line, at) : image.at<float>(at, line));
    };
    double before = 0.0, after = 0.0, sum = 0.0;
    for (int k = kCore + 1; k <= kCore + kPlateau; ++k) {
        before += value(near_place - k) / kPlateau;
        after += value(near_place + k) / kPlateau;
    }
    for (int k = -kCore; k <= kCore; ++k) sum += value(near_place + k) - after;
    return near_place - kCore - 0.5 + sum / (before - after);
}

/// How far edges in an image lie from where they should, px.
struct EdgeMisses {
    std::vector<double> sides;    ///< mean over a side, along its normal
    std::vector<double> corners;  ///< of lines fitted to two neighbouring sides, where they cross

    void add_polygon(const cv::Mat& image, const CameraModel& model,
                     const std::vector<Eigen::Vector3d>& polygon) {
        std::vector<Line> lines;
        for (std::size_t i = 0; i < polygon.size(); ++i)
            lines.push_back(fitted(image, model, polygon[i], polygon[(i + 1) % polygon.size()]));
        for (std::size_t i = 0; i < lines.size(); ++i) {
            const Line& line = lines[i];
            const Line& before = lines[(i + lines.size() - 1) % lines.size()];
            sides.push_back(std::abs(line.mean));
            // The shift of the crossing solves n . x = miss for both lines.
            Eigen::Matrix2d normals;
            normals << before.normal_at_end.transpose(), line.normal_at_start.transpose();
            corners.push_back(normals.colPivHouseholderQr()
                                  .solve(Eigen::Vector2d(before.at_end, line.at_start))
                                  .norm());
        }
    }
    static double mean(const std::vector<double>& v) {
        double sum = 0.0;
        for (const double x : v) sum += x;
        return sum / static_cast<double>(v.size());
    }
    double mean_side() const { return mean(sides); }
    double worst_side() const { return *std::max_element(sides.begin(), sides.end()); }
    double worst_corner() const { return *std::max_element(corners.begin(), corners.end()); }
    std::string told() const {
        std::ostringstream text;
        text << "sides: mean " << mean_side() << ", worst " << worst_side() << " px; corners: mean "
             << mean(corners) << ", worst " << worst_corner() << " px";
        return text.str();
    }

   private:
    struct Line {
        double mean, at_start, at_end;  ///< misses along the normal
        Eigen::Vector2d normal_at_start, normal_at_end;
    };

    static Eigen::Vector2d normal_of(const Eigen::Vector2d& along) {
        return Eigen::Vector2d(-along.y(), along.x()).normalized();
    }

    /// The middle of a side, pixel line by pixel line; then a straight line through the
    /// misses.
    static Line fitted(const cv::Mat& image, const CameraModel& model, const Eigen::Vector3d& a,
                       const Eigen::Vector3d& b) {
        // The true edge is a curve where there is distortion: followed in short steps.
        constexpr int kSteps = 400;
        std::vector<Eigen::Vector2d> curve;
        for (int i = 0; i <= kSteps; ++i)
            curve.push_back(model.project(a + (b - a) * i / kSteps).value());
        const Eigen::Vector2d span = curve.back() - curve.front();
        const int along = std::abs(span.x()) > std::abs(span.y()) ? 0 : 1, across = 1 - along;
        std::vector<Eigen::Vector2d> rows;  // place along the side 0 to 1, miss
        for (int i = kSteps / 5; i < kSteps * 4 / 5; ++i) {
            const Eigen::Vector2d &p = curve[static_cast<std::size_t>(i)],
                                  &q = curve[static_cast<std::size_t>(i) + 1];
            const double line = std::ceil(std::min(p(along), q(along)));
            if (line >= std::max(p(along), q(along))) continue;
            const double part = (line - p(along)) / (q(along) - p(along));
            const double truth = p(across) + part * (q(across) - p(across));
            const double found = edge_along(image, across == 0, static_cast<int>(line),
                                            static_cast<int>(std::lround(truth)));
            rows.emplace_back((i + part) / kSteps, (found - truth) * normal_of(q - p)(across));
        }
        Eigen::MatrixX2d A(rows.size(), 2);
        Eigen::VectorXd y(rows.size());
        for (Eigen::Index i = 0; i < y.size(); ++i) {
            A.row(i) << 1.0, rows[static_cast<std::size_t>(i)].x() - 0.5;
            y(i) = rows[static_cast<std::size_t>(i)].y();
        }
        const Eigen::Vector2d line = A.colPivHouseholderQr().solve(y);
        return {y.mean(), line(0) - 0.5 * line(1), line(0) + 0.5 * line(1),
                normal_of(curve[1] - curve[0]), normal_of(curve[kSteps] - curve[kSteps - 1])};
    }
};

}  // namespace petal::simulation
