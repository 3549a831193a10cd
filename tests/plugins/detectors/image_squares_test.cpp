// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "detectors/detail/image_squares.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <functional>
#include <opencv2/imgproc.hpp>

#include "detectors/detail/image_edge_sampler.hpp"

namespace petal {
namespace {

std::vector<cv::Point> turned_square(double half, double degrees, double squeeze = 1.0) {
    cv::Mat canvas(200, 200, CV_8U, cv::Scalar(0));
    std::vector<cv::Point> polygon;
    for (int i = 0; i < 4; ++i) {
        const double a = 0.017453292519943295 * (degrees + 90.0 * i + 225.0);
        polygon.emplace_back(
            static_cast<int>(std::lround(100 + half * 1.41421356 * std::cos(a))),
            static_cast<int>(std::lround(100 + squeeze * half * 1.41421356 * std::sin(a))));
    }
    cv::fillConvexPoly(canvas, polygon, cv::Scalar(255));
    std::vector<std::vector<cv::Point>> contours;
    cv::findContours(canvas, contours, cv::RETR_EXTERNAL, cv::CHAIN_APPROX_NONE);
    return contours.at(0);
}

// 2 px: the contour runs on whole pixels, and the drawn corner is rounded.
TEST(ImageSquares, CornersByDistanceOfTurnedAndSqueezedSquares) {
    for (const double squeeze : {1.0, 0.6}) {
        for (const double degrees : {0.0, 7.0, 20.0, 40.0, 66.0}) {
            const auto corners = corners_by_distance(turned_square(40.0, degrees, squeeze));
            for (int i = 0; i < 4; ++i) {
                const double a = 0.017453292519943295 * (degrees + 90.0 * i + 225.0);
                const Eigen::Vector2d truth(100 + 40.0 * 1.41421356 * std::cos(a),
                                            100 + squeeze * 40.0 * 1.41421356 * std::sin(a));
                double nearest = 1e9;
                for (const auto& corner : corners)
                    nearest = std::min(nearest, (corner - truth).norm());
                EXPECT_LT(nearest, 2.0) << degrees << " deg, squeezed by " << squeeze;
            }
            double twice = 0.0;
            for (std::size_t i = 0; i < 4; ++i) {
                const auto &p = corners[i], &q = corners[(i + 1) % 4];
                twice += p.x() * q.y() - p.y() * q.x();
            }
            EXPECT_GT(twice, 0.0) << "not clockwise at " << degrees << " deg";
        }
    }
}

cv::Mat page(const std::function<void(cv::Mat&)>& draw) {
    cv::Mat image(240, 320, CV_8U, cv::Scalar(200));
    draw(image);
    return image;
}

TEST(ImageSquares, ADarkSquareIsFoundOnceACircleAndABarAreNot) {
    const cv::Mat image = page([](cv::Mat& m) {
        cv::rectangle(m, cv::Rect(50, 60, 20, 20), cv::Scalar(60), cv::FILLED);
        cv::circle(m, cv::Point(150, 100), 12, cv::Scalar(60), cv::FILLED);
        cv::rectangle(m, cv::Rect(200, 60, 60, 8), cv::Scalar(60), cv::FILLED);
    });
    const SquareSearch search = find_squares(image, {});
    ASSERT_EQ(search.squares.size(), 1u);
    EXPECT_NEAR(search.squares[0].center.x(), 59.5, 0.6);
    EXPECT_NEAR(search.squares[0].center.y(), 69.5, 0.6);
    EXPECT_NEAR(search.squares[0].rectangularity, 1.0, 0.1);  // (6) of a square
    EXPECT_NEAR(search.squares[0].circularity, 0.785, 0.08);  // (7): pi / 4
}

TEST(ImageSquares, TheLimitsDecide) {
    const cv::Mat image = page(
        [](cv::Mat& m) { cv::rectangle(m, cv::Rect(50, 60, 20, 20), cv::Scalar(60), cv::FILLED); });
    SquareLimits limits;
    limits.max_area = 0.004;  // 307 px^2, the hole has about 420
    EXPECT_TRUE(find_squares(image, limits).squares.empty());
    limits = {};
    limits.min_area = 0.01;
    EXPECT_TRUE(find_squares(image, limits).squares.empty());
    limits = {};
    limits.min_circularity = 0.9;
    EXPECT_TRUE(find_squares(image, limits).squares.empty());
}

// A blurred step whose place is known: 0.02 px is what sampling and interpolation leave.
TEST(ImageEdgeSampler, FindsABlurredStepToAFiftiethOfAPixel) {
    for (const double place : {30.0, 30.2, 30.5, 30.77}) {
        cv::Mat image(40, 64, CV_8U);
        for (int y = 0; y < image.rows; ++y)
            for (int x = 0; x < image.cols; ++x)
                image.at<std::uint8_t>(y, x) = cv::saturate_cast<std::uint8_t>(
                    50.0 + 100.0 * 0.5 * std::erfc((place - x) / (1.0 * 1.41421356)));
        const EdgeSampler edges(image);
        const auto edge = edges.steepest_rise({31.0, 20.0}, {1.0, 0.0}, 4.0);
        ASSERT_TRUE(edge.has_value());
        EXPECT_NEAR(31.0 + edge->offset, place, 0.02);
        EXPECT_FALSE(edges.steepest_rise({31.0, 20.0}, {-1.0, 0.0}, 4.0).has_value()) << "a fall";
        EXPECT_FALSE(edges.steepest_rise({62.0, 20.0}, {1.0, 0.0}, 4.0).has_value()) << "outside";
    }
}

}  // namespace
}  // namespace petal
