// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "detectors/detail/image_board_overlay.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "petal/calibration/file_name.hpp"
#include "petal/calibration/picture_file.hpp"

namespace petal {

namespace {

const cv::Scalar kYellow(0, 220, 255), kMagenta(255, 0, 255), kGreen(0, 255, 0),
    kOrange(0, 128, 255);
constexpr int kShift = 4;  ///< OpenCV's drawing takes fixed-point coordinates: 1/16 px

/// An enlarged part of the photo, and drawing on it in the photo's own pixels.
class Canvas {
   public:
    Canvas(const cv::Mat& image, const cv::Rect& part, double scale) : part_(part), scale_(scale) {
        cv::Mat bgr;
        if (image.channels() == 1)
            cv::cvtColor(image(part), bgr, cv::COLOR_GRAY2BGR);
        else
            image(part).copyTo(bgr);
        cv::resize(bgr, drawing_, cv::Size(), scale, scale, cv::INTER_NEAREST);
    }

    void polygon(const std::array<Eigen::Vector2d, 4>& corners, const cv::Scalar& color) {
        for (std::size_t i = 0; i < 4; ++i)
            cv::line(drawing_, fixed(corners[i]), fixed(corners[(i + 1) % 4]), color, 1,
                     cv::LINE_AA, kShift);
    }
    void cross(const Eigen::Vector2d& p, double size_px, const cv::Scalar& color) {
        const Eigen::Vector2d x(size_px, 0.0), y(0.0, size_px);
        cv::line(drawing_, fixed(p - x), fixed(p + x), color, 1, cv::LINE_AA, kShift);
        cv::line(drawing_, fixed(p - y), fixed(p + y), color, 1, cv::LINE_AA, kShift);
    }
    void ellipse(const Eigen::Vector2d& p, const Eigen::Matrix2d& covariance, double sigmas,
                 const cv::Scalar& color) {
        const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes(covariance);
        const Eigen::Vector2d radii =
            axes.eigenvalues().cwiseMax(0.0).cwiseSqrt() * sigmas * scale_;
        const Eigen::Vector2d first = axes.eigenvectors().col(0);
        const auto whole = [](double v) {
            return static_cast<int>(std::lround(v * (1 << kShift)));
        };
        cv::ellipse(drawing_, fixed(p), cv::Size(whole(radii(0)), whole(radii(1))),
                    std::atan2(first.y(), first.x()) * 57.29577951308232, 0.0, 360.0, color, 1,
                    cv::LINE_AA, kShift);
    }
    void text(const Eigen::Vector2d& p, const std::string& words, double size,
              const cv::Scalar& color) {
        cv::Point at = fixed(p);
        at = cv::Point((at.x >> kShift) + 4, (at.y >> kShift) - 4);
        at.x = std::clamp(at.x, 0, std::max(0, drawing_.cols - 20));
        at.y = std::clamp(at.y, 12, std::max(12, drawing_.rows - 4));
        cv::putText(drawing_, words, at, cv::FONT_HERSHEY_SIMPLEX, size, cv::Scalar(0, 0, 0), 3,
                    cv::LINE_AA);
        cv::putText(drawing_, words, at, cv::FONT_HERSHEY_SIMPLEX, size, color, 1, cv::LINE_AA);
    }
    void write(const std::filesystem::path& file) const { write_picture(file, drawing_); }

   private:
    /// The centre of the photo's pixel (0, 0) lies in the middle of the enlarged pixel.
    cv::Point fixed(const Eigen::Vector2d& p) const {
        const auto place = [this](double v, int begin) {
            // Far outside the picture all places are alike; the bound keeps the integer in range.
            const double enlarged = std::clamp((v - begin + 0.5) * scale_ - 0.5, -1e5, 1e5);
            return static_cast<int>(std::lround(enlarged * (1 << kShift)));
        };
        return {place(p.x(), part_.x), place(p.y(), part_.y)};
    }

    cv::Rect part_;
    double scale_;
    cv::Mat drawing_;
};

void draw_corners(Canvas& canvas, const ImageSearchPicture& picture, std::size_t index,
                  double cross_px, double text_size, bool ellipses) {
    const ImageBoard& board = picture.boards[index];
    for (std::size_t c = 0; c < board.corners.size(); ++c) {
        const cv::Scalar& color = picture.corner_measured[index][c] ? kGreen : kOrange;
        canvas.cross(board.corners[c], cross_px, color);
        if (ellipses) canvas.ellipse(board.corners[c], board.covariance[c], 3.0, color);
        canvas.text(board.corners[c], std::to_string(c), text_size, color);
    }
}

}  // namespace

void write_overlay(const ImageSearchPicture& picture, const std::filesystem::path& file) {
    const int width = picture.image.cols;
    const double scale = std::clamp(std::ceil(1600.0 / width), 1.0, 4.0);
    Canvas canvas(picture.image, cv::Rect(0, 0, width, picture.image.rows), scale);
    for (const auto& square : picture.squares) canvas.polygon(square, kYellow);
    for (const RejectedGroup& group : picture.rejected) {
        canvas.polygon(group.outline, kMagenta);
        canvas.text(group.outline[0], group.reason, 0.4, kMagenta);
    }
    for (std::size_t i = 0; i < picture.boards.size(); ++i)
        draw_corners(canvas, picture, i, 3.0 / scale, 0.3, false);
    canvas.write(file);
}

void write_board_crop(const ImageSearchPicture& picture, std::size_t board,
                      const std::filesystem::path& file) {
    Eigen::Vector2d low = picture.boards[board].corners.front(), high = low;
    for (const auto& corner : picture.boards[board].corners) {
        low = low.cwiseMin(corner);
        high = high.cwiseMax(corner);
    }
    const double margin = 0.4 * (high - low).maxCoeff();
    const cv::Rect wanted(static_cast<int>(low.x() - margin), static_cast<int>(low.y() - margin),
                          static_cast<int>(high.x() - low.x() + 2.0 * margin) + 1,
                          static_cast<int>(high.y() - low.y() + 2.0 * margin) + 1);
    const cv::Rect part = wanted & cv::Rect(0, 0, picture.image.cols, picture.image.rows);
    const double scale =
        std::clamp(std::ceil(900.0 / std::max(part.width, part.height)), 1.0, 20.0);
    Canvas canvas(picture.image, part, scale);
    draw_corners(canvas, picture, board, 5.0 / scale, 0.4, true);
    canvas.write(file);
}

void save_pictures(Run& run, const std::string& name, const std::string& camera,
                   const ImageSearchPicture& picture) {
    if (!picture.boards.empty() && !run.debug()) return;
    const std::string label = file_name(camera);
    run.save(name + "_" + label + ".png",
             [&picture](const std::filesystem::path& file) { write_overlay(picture, file); });
    for (std::size_t i = 0; i < picture.boards.size(); ++i)
        run.save("board_" + label + "_" + std::to_string(i) + ".png",
                 [&picture, i](const std::filesystem::path& file) {
                     write_board_crop(picture, i, file);
                 });
}

}  // namespace petal
