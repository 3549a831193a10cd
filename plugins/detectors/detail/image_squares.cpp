// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "detectors/detail/image_squares.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "detectors/detail/image_binaries.hpp"
#include "petal/calibration/angles.hpp"

namespace petal {

namespace {

/// The quadrilateral of the corners must fill this part of the contour's hull: 0.64 for a circle, 1
/// for a square. Small holes lose up to a fifth, since their traced corners are cut.
constexpr double kMinQuadFill = 0.75;

double quad_area(const std::array<Eigen::Vector2d, 4>& q) {
    double twice = 0.0;
    for (std::size_t i = 0; i < 4; ++i) {
        const auto& a = q[i];
        const auto& b = q[(i + 1) % 4];
        twice += a.x() * b.y() - a.y() * b.x();
    }
    return 0.5 * twice;
}

/// Rows first: the binary images are visited in a fixed order, so this makes the list canonical.
bool before(const SquareCandidate& a, const SquareCandidate& b) {
    if (a.center.y() != b.center.y()) return a.center.y() < b.center.y();
    if (a.center.x() != b.center.x()) return a.center.x() < b.center.x();
    return a.area < b.area;
}

/// How far a candidate is from the ideal square; picks the best of one region's versions.
double misfit(const SquareCandidate& s) {
    return (s.rectangularity - 1.0) + std::abs(s.circularity - kPi / 4.0);
}

class Collector {
   public:
    Collector(const cv::Mat& grey, const SquareLimits& limits) : limits_(limits) {
        const double pixels = static_cast<double>(grey.cols) * grey.rows;
        // Below 3 x 3 pixels a contour has no shape.
        min_area_ = std::max(9.0, limits.min_area * pixels);
        max_area_ = limits.max_area * pixels;
    }

    void add(const cv::Mat& bright) {
        contours_.clear();
        cv::findContours(bright, contours_, hierarchy_, cv::RETR_CCOMP, cv::CHAIN_APPROX_NONE);
        for (std::size_t i = 0; i < contours_.size(); ++i) {
            const bool is_hole = hierarchy_[i][3] >= 0;
            if (is_hole) judge(contours_[i]);
        }
    }

    SquareSearch take() {
        std::vector<SquareCandidate> merged = merge();
        std::sort(merged.begin(), merged.end(), before);
        return {std::move(merged), borders_};
    }

   private:
    void judge(const std::vector<cv::Point>& contour) {
        // The perimeter of a region of area A is at least 2 sqrt(pi A), and at most that allowed by
        // (7).
        const double points = static_cast<double>(contour.size());
        if (points * points < 6.0 * min_area_ || contour.size() < 8) return;
        const double area = cv::contourArea(contour);
        if (area < min_area_ || area > max_area_) return;
        ++borders_;
        const double length = cv::arcLength(contour, true);
        const double circularity = 4.0 * kPi * area / (length * length);
        if (circularity < limits_.min_circularity || circularity > limits_.max_circularity) return;
        cv::convexHull(contour, hull_);
        const double hull_area = cv::contourArea(hull_);
        const cv::RotatedRect rect = cv::minAreaRect(hull_);
        const double rectangularity = static_cast<double>(rect.size.width) *
                                      static_cast<double>(rect.size.height) / hull_area;
        if (rectangularity > limits_.max_rectangularity) return;
        SquareCandidate square;
        square.corners = corners_by_distance(contour);
        square.area = quad_area(square.corners);
        if (square.area < kMinQuadFill * hull_area) return;
        for (const auto& corner : square.corners) square.center += 0.25 * corner;
        square.rectangularity = rectangularity;
        square.circularity = circularity;
        found_.push_back(square);
    }

    /// One candidate for each region: versions of nearly the same place and size are one.
    std::vector<SquareCandidate> merge() const {
        std::vector<SquareCandidate> order = found_;
        std::stable_sort(order.begin(), order.end(), before);
        std::vector<SquareCandidate> kept;
        std::size_t first_near = 0;
        const double reach = std::sqrt(max_area_);
        for (const SquareCandidate& square : order) {
            const double side = std::sqrt(square.area);
            while (first_near < kept.size() &&
                   kept[first_near].center.y() < square.center.y() - reach)
                ++first_near;
            SquareCandidate* twin = nullptr;
            for (std::size_t k = kept.size(); k-- > first_near && !twin;) {
                const bool near = (kept[k].center - square.center).norm() < 0.12 * side;
                const double ratio = kept[k].area / square.area;
                if (near && ratio > 0.75 && ratio < 1.0 / 0.75) twin = &kept[k];
            }
            if (!twin) {
                kept.push_back(square);
                continue;
            }
            const int votes = twin->votes + square.votes;
            // The place in the list stays sorted: only the shape is replaced, the centre stays
            // close.
            if (misfit(square) < misfit(*twin)) {
                const Eigen::Vector2d center = twin->center;
                *twin = square;
                twin->center = center;
            }
            twin->votes = votes;
        }
        for (SquareCandidate& square : kept) {
            square.center.setZero();
            for (const auto& corner : square.corners) square.center += 0.25 * corner;
        }
        return kept;
    }

    SquareLimits limits_;
    double min_area_ = 0.0;
    double max_area_ = 0.0;
    int borders_ = 0;
    std::vector<SquareCandidate> found_;
    std::vector<std::vector<cv::Point>> contours_;
    std::vector<cv::Vec4i> hierarchy_;
    std::vector<cv::Point> hull_;
};

}  // namespace

std::array<Eigen::Vector2d, 4> corners_by_distance(const std::vector<cv::Point>& contour) {
    Eigen::Vector2d centroid = Eigen::Vector2d::Zero();
    for (const cv::Point& p : contour) centroid += Eigen::Vector2d(p.x, p.y);
    centroid /= static_cast<double>(contour.size());
    const auto farthest = [&contour](auto&& distance) {
        std::size_t best = 0;
        double best_distance = -1.0;
        for (std::size_t i = 0; i < contour.size(); ++i) {
            const double d = distance(Eigen::Vector2d(contour[i].x, contour[i].y));
            if (d > best_distance) {
                best_distance = d;
                best = i;
            }
        }
        return Eigen::Vector2d(contour[best].x, contour[best].y);
    };
    const Eigen::Vector2d first = farthest([&](const auto& p) { return (p - centroid).norm(); });
    const Eigen::Vector2d second = farthest([&](const auto& p) { return (p - first).norm(); });
    const Eigen::Vector2d third =
        farthest([&](const auto& p) { return (p - first).norm() + (p - second).norm(); });
    // The letter takes the fourth as the point farthest from the third. On a skewed square that may
    // be the first or second again; the farthest on the other side of their diagonal cannot be.
    const Eigen::Vector2d diagonal = second - first;
    const auto side = [&](const Eigen::Vector2d& p) {
        return diagonal.x() * (p - first).y() - diagonal.y() * (p - first).x();
    };
    const double side_of_third = side(third) < 0.0 ? -1.0 : 1.0;
    const Eigen::Vector2d fourth =
        farthest([&](const auto& p) { return -side_of_third * side(p); });
    std::array<Eigen::Vector2d, 4> corners{first, third, second, fourth};
    if (quad_area(corners) < 0.0)
        std::swap(corners[1], corners[3]);  // y runs down: clockwise is > 0
    const auto top_left =
        std::min_element(corners.begin(), corners.end(),
                         [](const auto& a, const auto& b) { return a.sum() < b.sum(); });
    std::rotate(corners.begin(), top_left, corners.end());
    return corners;
}

SquareSearch find_squares(const cv::Mat& grey, const SquareLimits& limits,
                          const std::function<void()>& check) {
    Collector collector(grey, limits);
    if (grey.cols < 8 || grey.rows < 8) return collector.take();
    visit_binaries(grey, limits.levels, [&](const cv::Mat& bright) {
        if (check) check();
        collector.add(bright);
    });
    return collector.take();
}

}  // namespace petal
