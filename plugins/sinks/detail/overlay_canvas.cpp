// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "sinks/detail/overlay_canvas.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <optional>

namespace petal {

namespace {

// OpenCV draws with sub-pixel coordinates given in fixed point of so many bits.
constexpr int kShift = 4;

const cv::Scalar kGreen(60, 220, 60);
const cv::Scalar kRed(40, 40, 255);
const cv::Scalar kYellow(0, 230, 255);

/// A projected point with its distance from the camera.
struct Dot {
    Eigen::Vector2d pixel;
    double range;
};

std::vector<Dot> project_cloud(const Cloud& cloud, const Eigen::Isometry3d& T_camera_lidar,
                               const CameraModel& model, std::size_t max_points) {
    std::vector<Dot> dots;
    if (max_points == 0) return dots;
    const auto& points = *cloud.points;
    const std::size_t step =
        std::max<std::size_t>(1, (points.size() + max_points - 1) / max_points);
    const auto& xs = points.getPointsBufferRef_x();
    const auto& ys = points.getPointsBufferRef_y();
    const auto& zs = points.getPointsBufferRef_z();
    for (std::size_t i = 0; i < points.size(); i += step) {
        const Eigen::Vector3d p(xs[i], ys[i], zs[i]);
        if (!p.allFinite()) continue;
        const Eigen::Vector3d in_camera = T_camera_lidar * p;
        const auto pixel = model.project(in_camera);
        if (!pixel || pixel->x() < -1.0 || pixel->y() < -1.0 || pixel->x() > model.camera().ncols ||
            pixel->y() > model.camera().nrows)
            continue;
        dots.push_back({*pixel, in_camera.norm()});
    }
    return dots;
}

/// Red for the near end of the range, blue for the far end.
cv::Scalar depth_colour(double fraction) {
    const double f = std::clamp(fraction, 0.0, 1.0);
    const double green = 1.0 - std::abs(2.0 * f - 1.0);
    return cv::Scalar(255.0 * f, 200.0 * green, 255.0 * (1.0 - f));
}

}  // namespace

OverlayCanvas::OverlayCanvas(const CameraImage& image, int magnification, int line_width,
                             const cv::Rect& part)
    : model_(image.camera),
      magnification_(magnification),
      line_width_(line_width),
      begin_(part.tl()) {
    const cv::Mat whole = image.image.asCvMat<cv::Mat>(mrpt::img::SHALLOW_COPY);
    const cv::Mat photo = part.empty() ? whole : whole(part);
    cv::Mat colour;
    if (photo.channels() == 1) {
        cv::cvtColor(photo, colour, cv::COLOR_GRAY2BGR);
    } else {
        colour = photo;
    }
    // A copy in any case: the packet's pixels must not be drawn on.
    cv::resize(colour, picture_, cv::Size(), magnification, magnification, cv::INTER_CUBIC);
    if (picture_.data == photo.data) picture_ = picture_.clone();
}

cv::Point OverlayCanvas::at(const Eigen::Vector2d& pixel) const {
    // The centre of pixel (0, 0) lies at (m - 1) / 2 of the magnified picture.
    const double m = magnification_;
    const auto fixed = [m](double value) {
        return static_cast<int>(std::lround(((value + 0.5) * m - 0.5) * (1 << kShift)));
    };
    return {fixed(pixel.x() - begin_.x), fixed(pixel.y() - begin_.y)};
}

void OverlayCanvas::draw_cloud(const Cloud& cloud, const Eigen::Isometry3d& T_camera_lidar,
                               std::size_t max_points, double dot) {
    const std::vector<Dot> dots = project_cloud(cloud, T_camera_lidar, model_, max_points);
    if (dots.empty()) return;
    std::vector<double> ranges;
    ranges.reserve(dots.size());
    for (const Dot& one : dots) ranges.push_back(one.range);
    // The 5 % and 95 % ends, so that one far point does not take the colours from all others.
    const auto quantile = [&ranges](double q) {
        const auto k = static_cast<std::ptrdiff_t>(q * static_cast<double>(ranges.size() - 1));
        std::nth_element(ranges.begin(), ranges.begin() + k, ranges.end());
        return ranges[static_cast<std::size_t>(k)];
    };
    const double nearest = quantile(0.05);
    const double span = std::max(1e-6, quantile(0.95) - nearest);
    const int radius = static_cast<int>(dot * magnification_ * line_width_ * (1 << kShift) / 2.0);
    for (const Dot& one : dots)
        cv::circle(picture_, at(one.pixel), radius, depth_colour((one.range - nearest) / span),
                   cv::FILLED, cv::LINE_AA, kShift);
}

void OverlayCanvas::draw_detected(const std::vector<Eigen::Vector2d>& corners) {
    const int arm = (3 * magnification_ * line_width_ << kShift) / 2;
    for (const Eigen::Vector2d& corner : corners) {
        const cv::Point p = at(corner);
        cv::line(picture_, {p.x - arm, p.y}, {p.x + arm, p.y}, kGreen, line_width_, cv::LINE_AA,
                 kShift);
        cv::line(picture_, {p.x, p.y - arm}, {p.x, p.y + arm}, kGreen, line_width_, cv::LINE_AA,
                 kShift);
    }
}

void OverlayCanvas::draw_projected(const std::vector<Eigen::Vector3d>& corners,
                                   const Eigen::Isometry3d& T_camera_lidar) {
    for (const Eigen::Vector3d& corner : corners)
        if (const auto pixel = model_.project(T_camera_lidar * corner))
            cv::circle(picture_, at(*pixel), (2 * magnification_ * line_width_) << kShift, kRed,
                       line_width_, cv::LINE_AA, kShift);
}

void OverlayCanvas::draw_residuals(const std::vector<PointPair>& pairs,
                                   const Eigen::Isometry3d& T_camera_lidar, double scale) {
    for (const PointPair& pair : pairs)
        if (const auto pixel = model_.project(T_camera_lidar * pair.lidar))
            cv::line(picture_, at(pair.image), at(pair.image + scale * (pair.image - *pixel)),
                     kYellow, line_width_, cv::LINE_AA, kShift);
}

void OverlayCanvas::draw_caption(const std::string& text) {
    const cv::Point at_bottom(8, picture_.rows - 10);
    const double size = 0.6;
    cv::putText(picture_, text, at_bottom, cv::FONT_HERSHEY_SIMPLEX, size, cv::Scalar::all(0), 4,
                cv::LINE_AA);
    cv::putText(picture_, text, at_bottom, cv::FONT_HERSHEY_SIMPLEX, size, cv::Scalar::all(255), 1,
                cv::LINE_AA);
}

}  // namespace petal
