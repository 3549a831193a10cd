// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "metrics/detail/image_shift.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <opencv2/imgproc.hpp>

namespace petal {
namespace {

constexpr double kFloorPx = 0.02;    // what the same corner differs by in two images of one scene
constexpr double kMostMovePx = 3.0;  // cornerSubPix that went farther has found something else
constexpr std::size_t kFewestCorners = 4;

double seconds_between(const CameraImage& a, const CameraImage& b) {
    return mrpt::Clock::toDouble(b.stamp) - mrpt::Clock::toDouble(a.stamp);
}

/// The least distance of two corners, px.
double closest(const std::vector<Eigen::Vector2d>& corners) {
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < corners.size(); ++i)
        for (std::size_t j = i + 1; j < corners.size(); ++j)
            least = std::min(least, (corners[i] - corners[j]).norm());
    return least;
}

/// The corners in this image; NaN where they are not found.
std::vector<Eigen::Vector2d> find_again(const CameraImage& image,
                                        const std::vector<Eigen::Vector2d>& corners) {
    const cv::Mat pixels = image.image.asCvMat<cv::Mat>(mrpt::img::SHALLOW_COPY);
    cv::Mat grey;
    if (pixels.channels() == 3) {
        cv::cvtColor(pixels, grey, cv::COLOR_BGR2GRAY);
    } else {
        grey = pixels;
    }
    const Eigen::Vector2d nowhere =
        Eigen::Vector2d::Constant(std::numeric_limits<double>::quiet_NaN());
    std::vector<Eigen::Vector2d> found(corners.size(), nowhere);
    // The window must see one corner alone.
    const int half = static_cast<int>(std::clamp(0.3 * closest(corners), 2.0, 7.0));
    for (std::size_t i = 0; i < corners.size(); ++i) {
        const Eigen::Vector2d& corner = corners[i];
        const double border = half + 2.0;
        if (!corner.allFinite() || corner.minCoeff() < border ||
            corner.x() > grey.cols - 1 - border || corner.y() > grey.rows - 1 - border)
            continue;
        std::vector<cv::Point2f> one{
            {static_cast<float>(corner.x()), static_cast<float>(corner.y())}};
        cv::cornerSubPix(grey, one, {half, half}, {-1, -1},
                         {cv::TermCriteria::COUNT + cv::TermCriteria::EPS, 50, 1e-3});
        const Eigen::Vector2d at(static_cast<double>(one[0].x), static_cast<double>(one[0].y));
        if ((at - corner).norm() <= kMostMovePx) found[i] = at;
    }
    return found;
}

double median(std::vector<double> values) {
    const auto half = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), half, values.end());
    return *half;
}

}  // namespace

std::vector<const CameraImage*> spread_images(const Images& images, const std::string& camera) {
    std::vector<const CameraImage*> all;
    for (const auto* list : {&images.cameras, &images.others})
        for (const CameraImage& image : *list)
            if (image.label == camera && !image.image.isEmpty()) all.push_back(&image);
    std::stable_sort(all.begin(), all.end(), [](const CameraImage* a, const CameraImage* b) {
        return a->stamp < b->stamp;
    });
    if (all.size() > 3) all = {all.front(), all[all.size() / 2], all.back()};
    return all;
}

std::vector<ImageShift> image_shifts(const std::vector<const CameraImage*>& images,
                                     const ImageBoard& board, double radius_m) {
    std::vector<std::vector<Eigen::Vector2d>> found;
    for (const CameraImage* image : images) found.push_back(find_again(*image, board.corners));
    const double radius_px = corner_radius(board.corners);
    std::vector<ImageShift> shifts;
    for (std::size_t a = 0; a < images.size(); ++a)
        for (std::size_t b = a + 1; b < images.size(); ++b) {
            std::vector<double> u, v, off;
            for (std::size_t i = 0; i < board.corners.size(); ++i) {
                const Eigen::Vector2d moved = found[b][i] - found[a][i];
                if (!moved.allFinite()) continue;
                u.push_back(moved.x());
                v.push_back(moved.y());
            }
            if (u.size() < kFewestCorners || !(radius_px > 0.0)) continue;
            ImageShift shift;
            shift.from = a == 0 ? "first" : "middle";
            shift.to = b + 1 == images.size() ? "last" : "middle";
            shift.seconds = seconds_between(*images[a], *images[b]);
            shift.px = {median(u), median(v)};
            for (std::size_t i = 0; i < u.size(); ++i)
                off.push_back(std::hypot(u[i] - shift.px.x(), v[i] - shift.px.y()));
            // The median of a Rayleigh law is 1.18 sigma; a median of n has 1.25 sigma / sqrt(n).
            const double one = median(off) / 1.1774;
            shift.sigma_px =
                std::hypot(1.2533 * one / std::sqrt(static_cast<double>(u.size())), kFloorPx);
            shift.metres = shift.px.norm() * radius_m / radius_px;
            shift.sigma_metres = shift.sigma_px * radius_m / radius_px;
            shift.corners = u.size();
            shifts.push_back(shift);
        }
    return shifts;
}

double corner_radius(const std::vector<Eigen::Vector2d>& points) {
    if (points.size() < 2) return 0.0;
    Eigen::Vector2d mean = Eigen::Vector2d::Zero();
    for (const auto& p : points) mean += p / static_cast<double>(points.size());
    Eigen::Matrix2d scatter = Eigen::Matrix2d::Zero();
    for (const auto& p : points)
        scatter += (p - mean) * (p - mean).transpose() / static_cast<double>(points.size());
    if (!scatter.allFinite()) return 0.0;
    return std::sqrt(Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(scatter).eigenvalues().y());
}

}  // namespace petal
