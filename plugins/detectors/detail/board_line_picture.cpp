// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "detectors/detail/board_line_picture.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <opencv2/imgproc.hpp>
#include <string>

#include "petal/calibration/picture_file.hpp"

namespace petal {

void draw_attempt(const BoardAttempt& attempt, const std::filesystem::path& file) {
    constexpr double kBorder = 0.05;      // m
    constexpr double kMaxExtent = 3.0;    // m
    constexpr double kScale = 1000.0;     // px / m
    constexpr double kHalfLength = 0.25;  // m, of a drawn line
    Eigen::AlignedBox2d box(Eigen::Vector2d(-0.3, -0.3), Eigen::Vector2d(0.3, 0.3));
    for (const auto& p : attempt.points) box.extend(p);
    box = box.intersection(Eigen::AlignedBox2d(Eigen::Vector2d::Constant(-kMaxExtent / 2.0),
                                               Eigen::Vector2d::Constant(kMaxExtent / 2.0)));
    const Eigen::Vector2d size = (box.sizes() + Eigen::Vector2d::Constant(2.0 * kBorder)) * kScale;
    cv::Mat picture(static_cast<int>(size.y()), static_cast<int>(size.x()), CV_8UC3,
                    cv::Scalar::all(255));
    const auto pixel = [&](const Eigen::Vector2d& p) {
        const Eigen::Vector2d q = (p - box.min() + Eigen::Vector2d::Constant(kBorder)) * kScale;
        return cv::Point(cvRound(q.x()), cvRound(q.y()));
    };
    for (const PlanarLine& line : attempt.lines)
        cv::line(picture, pixel(line.point - kHalfLength * line.direction),
                 pixel(line.point + kHalfLength * line.direction), cv::Scalar(200, 200, 200), 1,
                 cv::LINE_AA);
    for (const auto& p : attempt.points)
        cv::circle(picture, pixel(p), 2, cv::Scalar(0, 0, 0), cv::FILLED, cv::LINE_AA);
    const cv::Scalar colour = attempt.board ? cv::Scalar(0, 160, 0) : cv::Scalar(0, 0, 220);
    for (std::size_t i = 0; i < attempt.corners.size(); ++i) {
        cv::drawMarker(picture, pixel(attempt.corners[i]), colour, cv::MARKER_CROSS, 14, 2);
        cv::putText(picture, std::to_string(i), pixel(attempt.corners[i]) + cv::Point(6, -6),
                    cv::FONT_HERSHEY_SIMPLEX, 0.4, colour, 1, cv::LINE_AA);
    }
    const std::string caption = attempt.board          ? "board"
                                : attempt.miss.empty() ? "no board"
                                                       : attempt.miss;
    cv::putText(picture, caption, {10, 20}, cv::FONT_HERSHEY_SIMPLEX, 0.4, colour, 1, cv::LINE_AA);
    write_picture(file, picture);
}

}  // namespace petal
