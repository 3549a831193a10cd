// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "metrics/detail/image_shift.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <opencv2/imgproc.hpp>
#include <optional>

namespace petal {
namespace {

constexpr double kFloorPx = 0.02;    // what the same corner differs by in two images of one scene
constexpr double kMostMovePx = 3.0;  // cornerSubPix that went farther has found something else
constexpr int kSearchPx = 40;        // how far a board is searched for as a whole, each way
constexpr int kMarginPx = 8;         // around its corners: their outer sides belong to them
constexpr double kLeastAlike = 0.7;  // correlation of the board in two images; one hole off: 0.5
constexpr double kNudgePx = 0.37;    // other start of a corner that did not move at all

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

cv::Mat grey_of(const CameraImage& image) {
    cv::Mat pixels = image.image.asCvMat<cv::Mat>(mrpt::img::SHALLOW_COPY);
    if (pixels.channels() != 3) return pixels;
    cv::Mat grey;
    cv::cvtColor(pixels, grey, cv::COLOR_BGR2GRAY);
    return grey;
}

/// Where the board lies in `image` against `reference`, whole px: best normalised correlation of
/// its picture. None where nothing is alike, or the best lies at the end of the search.
std::optional<Eigen::Vector2d> whole_shift(const cv::Mat& reference, const cv::Mat& image,
                                           const std::vector<Eigen::Vector2d>& corners) {
    if (reference.size() != image.size() || reference.type() != image.type()) return std::nullopt;
    std::vector<cv::Point2f> points;
    for (const Eigen::Vector2d& p : corners)
        if (p.allFinite())
            points.emplace_back(static_cast<float>(p.x()), static_cast<float>(p.y()));
    if (points.empty()) return std::nullopt;
    const auto grown = [&](const cv::Rect& box, int by) {
        return cv::Rect(box.x - by, box.y - by, box.width + 2 * by, box.height + 2 * by) &
               cv::Rect(0, 0, image.cols, image.rows);
    };
    const cv::Rect board = grown(cv::boundingRect(points), kMarginPx);
    if (board.empty()) return std::nullopt;
    const cv::Rect search = grown(board, kSearchPx);
    cv::Mat alike;
    cv::matchTemplate(image(search), reference(board), alike, cv::TM_CCOEFF_NORMED);
    double most = 0.0;
    cv::Point at;
    cv::minMaxLoc(alike, nullptr, &most, nullptr, &at);
    // Without contrast the correlation is infinite or no number.
    if (!(most >= kLeastAlike && most < 1.01)) return std::nullopt;
    const cv::Point moved = at + search.tl() - board.tl();
    if (std::max(std::abs(moved.x), std::abs(moved.y)) >= kSearchPx) return std::nullopt;
    return Eigen::Vector2d(moved.x, moved.y);
}

/// A corner refined from `start`; none where cornerSubPix gives the start back, as it does where
/// there is no gradient and where it left its window.
std::optional<Eigen::Vector2d> refined(const cv::Mat& grey, const Eigen::Vector2d& start,
                                       int half) {
    // A corner may lie exactly at its start: then another start leads there too.
    for (const double nudge : {0.0, kNudgePx}) {
        const cv::Point2f from(static_cast<float>(start.x() + nudge),
                               static_cast<float>(start.y() + nudge));
        std::vector<cv::Point2f> one{from};
        cv::cornerSubPix(grey, one, {half, half}, {-1, -1},
                         {cv::TermCriteria::COUNT + cv::TermCriteria::EPS, 50, 1e-3});
        if (one[0] == from) continue;
        const Eigen::Vector2d at(static_cast<double>(one[0].x), static_cast<double>(one[0].y));
        if ((at - start).norm() > kMostMovePx) return std::nullopt;
        return at;
    }
    return std::nullopt;
}

/// The corners in this image; NaN where they are not found.
std::vector<Eigen::Vector2d> find_again(const cv::Mat& reference, const CameraImage& image,
                                        const std::vector<Eigen::Vector2d>& corners) {
    const Eigen::Vector2d nowhere =
        Eigen::Vector2d::Constant(std::numeric_limits<double>::quiet_NaN());
    std::vector<Eigen::Vector2d> found(corners.size(), nowhere);
    const cv::Mat grey = grey_of(image);
    const auto shift = whole_shift(reference, grey, corners);
    if (!shift) return found;
    // The window must see one corner alone.
    const int half = static_cast<int>(std::clamp(0.3 * closest(corners), 2.0, 7.0));
    const double border = half + 2.0;
    for (std::size_t i = 0; i < corners.size(); ++i) {
        const Eigen::Vector2d start = corners[i] + *shift;
        if (!start.allFinite() || start.minCoeff() < border || start.x() > grey.cols - 1 - border ||
            start.y() > grey.rows - 1 - border)
            continue;
        if (const auto corner = refined(grey, start, half)) found[i] = *corner;
    }
    return found;
}

std::size_t finite_count(const std::vector<Eigen::Vector2d>& points) {
    return static_cast<std::size_t>(std::count_if(
        points.begin(), points.end(), [](const Eigen::Vector2d& p) { return p.allFinite(); }));
}

double median_shift(std::vector<double> values) {
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

const CameraImage* board_image(const Images& images, const std::string& camera) {
    for (const CameraImage& image : images.cameras)
        if (image.label == camera && !image.image.isEmpty()) return &image;
    return nullptr;
}

ImageShifts image_shifts(const std::vector<const CameraImage*>& images,
                         const CameraImage& reference, const ImageBoard& board, double radius_m) {
    ImageShifts result;
    const cv::Mat seen = grey_of(reference);
    if (finite_count(find_again(seen, reference, board.corners)) < kFewestShiftCorners)
        return result;
    std::vector<std::vector<Eigen::Vector2d>> found;
    const auto name = [&](std::size_t i) -> std::string {
        return i == 0 ? "first" : i + 1 == images.size() ? "last" : "middle";
    };
    for (std::size_t i = 0; i < images.size(); ++i) {
        found.push_back(find_again(seen, *images[i], board.corners));
        const std::size_t count = finite_count(found.back());
        if (count < kFewestShiftCorners)
            result.lost.push_back(
                {name(i), std::abs(seconds_between(reference, *images[i])), count});
    }
    const double radius_px = corner_radius(board.corners);
    std::vector<ImageShift>& shifts = result.shifts;
    for (std::size_t a = 0; a < images.size(); ++a)
        for (std::size_t b = a + 1; b < images.size(); ++b) {
            std::vector<double> u, v, off;
            for (std::size_t i = 0; i < board.corners.size(); ++i) {
                const Eigen::Vector2d moved = found[b][i] - found[a][i];
                if (!moved.allFinite()) continue;
                u.push_back(moved.x());
                v.push_back(moved.y());
            }
            if (u.size() < kFewestShiftCorners || !(radius_px > 0.0)) continue;
            ImageShift shift;
            shift.from = name(a);
            shift.to = name(b);
            shift.seconds = seconds_between(*images[a], *images[b]);
            shift.px = {median_shift(u), median_shift(v)};
            for (std::size_t i = 0; i < u.size(); ++i)
                off.push_back(std::hypot(u[i] - shift.px.x(), v[i] - shift.px.y()));
            // The median of a Rayleigh law is 1.18 sigma; a median of n has 1.25 sigma / sqrt(n).
            const double one = median_shift(off) / 1.1774;
            shift.sigma_px =
                std::hypot(1.2533 * one / std::sqrt(static_cast<double>(u.size())), kFloorPx);
            shift.metres = shift.px.norm() * radius_m / radius_px;
            shift.sigma_metres = shift.sigma_px * radius_m / radius_px;
            shift.corners = u.size();
            shifts.push_back(shift);
        }
    return result;
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
