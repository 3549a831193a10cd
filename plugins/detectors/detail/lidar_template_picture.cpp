// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "detectors/detail/lidar_template_picture.hpp"

#include <opencv2/imgproc.hpp>
#include <string>

#include "petal/calibration/picture_file.hpp"

namespace petal {

void draw_plate(const PlateTemplate& target, const PlateAttempt& attempt,
                const std::filesystem::path& file) {
    constexpr double kBoardWidth = 500.0;  // px
    constexpr double kAround = 0.35;       // of the board's radius
    const double scale = kBoardWidth / target.all.width();
    const double reach = target.all.radius() * (1.0 + kAround);
    const int size = static_cast<int>(2.0 * reach * scale);
    cv::Mat picture(size, size, CV_8UC3, cv::Scalar::all(255));
    const auto pixel = [&](const Eigen::Vector2d& p) {
        return cv::Point(cvRound((p.x() + reach) * scale), cvRound((p.y() + reach) * scale));
    };
    const auto dots = [&](const std::vector<Eigen::Vector2d>& places, const cv::Scalar& colour) {
        for (const Eigen::Vector2d& p : places)
            cv::circle(picture, pixel(p), 1, colour, cv::FILLED);
    };
    dots(attempt.misses, cv::Scalar(235, 205, 160));
    dots(attempt.hits, cv::Scalar(60, 60, 60));
    const cv::Scalar colour = attempt.board ? cv::Scalar(0, 170, 0) : cv::Scalar(0, 0, 220);
    if (attempt.placed)
        for (const PlateShape::SidePoint& p : target.all.along_sides(1.0 / scale, 0.0))
            cv::circle(picture, pixel(p.at), 1, colour, cv::FILLED);
    const std::string caption = attempt.board          ? "board"
                                : attempt.miss.empty() ? "no board"
                                                       : attempt.miss;
    cv::putText(picture, caption, {10, 20}, cv::FONT_HERSHEY_SIMPLEX, 0.45, colour, 1, cv::LINE_AA);
    write_picture(file, picture);
}

}  // namespace petal
