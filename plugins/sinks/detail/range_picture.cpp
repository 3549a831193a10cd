// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "sinks/detail/range_picture.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <opencv2/imgproc.hpp>
#include <string>
#include <utility>
#include <vector>

#include "petal/printed.hpp"

namespace petal {
namespace {

constexpr int kShades = 256;
constexpr int kScaleHeight = 40;  // px

/// From near (red) to far (blue), evenly bright to the eye.
std::vector<cv::Vec3b> shades() {
    cv::Mat ramp(1, kShades, CV_8UC1), coloured;
    for (int i = 0; i < kShades; ++i) ramp.at<unsigned char>(0, i) = static_cast<unsigned char>(i);
    cv::applyColorMap(ramp, coloured, cv::COLORMAP_TURBO);
    std::vector<cv::Vec3b> list(coloured.begin<cv::Vec3b>(), coloured.end<cv::Vec3b>());
    std::reverse(list.begin(), list.end());
    return list;
}

/// A dot on the photo.
struct RangeDot {
    cv::Point pixel;
    float depth, range;
};

/// The 2 % and the 98 % of what the points have.
std::pair<double, double> usual_ranges(const std::vector<RangeDot>& dots) {
    std::vector<float> ranges;
    ranges.reserve(dots.size());
    for (const RangeDot& dot : dots) ranges.push_back(dot.range);
    const auto at = [&ranges](double share) {
        const auto place =
            static_cast<std::ptrdiff_t>(share * static_cast<double>(ranges.size() - 1));
        std::nth_element(ranges.begin(), ranges.begin() + place, ranges.end());
        return static_cast<double>(ranges[static_cast<std::size_t>(place)]);
    };
    return {at(0.02), at(0.98)};
}

void draw_scale(cv::Mat& picture, int top, double low, double high,
                const std::vector<cv::Vec3b>& shade) {
    const int margin = 10, right = picture.cols - margin;
    for (int u = margin; u < right; ++u) {
        const auto i = static_cast<std::size_t>((u - margin) * (kShades - 1) / (right - margin));
        cv::line(picture, {u, top + 4}, {u, top + 14}, cv::Scalar(shade[i]));
    }
    for (int k = 0; k <= 4; ++k) {
        const std::string text = printed("%.1f m", low * std::pow(high / low, k / 4.0));
        const int width = cv::getTextSize(text, cv::FONT_HERSHEY_SIMPLEX, 0.45, 1, nullptr).width;
        const int u = margin + (right - margin) * k / 4;
        cv::putText(picture, text,
                    {std::clamp(u - width / 2, 2, picture.cols - width - 2), top + 32},
                    cv::FONT_HERSHEY_SIMPLEX, 0.45, cv::Scalar::all(230), 1, cv::LINE_AA);
    }
}

}  // namespace

cv::Mat range_picture(const cv::Mat& photo, const Cloud& cloud, const PointColours& seen,
                      const RangePictureStyle& style) {
    cv::Mat grey, picture(photo.rows + kScaleHeight, photo.cols, CV_8UC3, cv::Scalar::all(20));
    if (photo.channels() == 1)
        grey = photo;
    else
        cv::cvtColor(photo, grey, cv::COLOR_BGR2GRAY);
    cv::Mat photo_part = picture.rowRange(0, photo.rows), dim;
    grey.convertTo(dim, CV_8U, style.brightness);
    cv::cvtColor(dim, photo_part, cv::COLOR_GRAY2BGR);

    const auto& xs = cloud.points->getPointsBufferRef_x();
    const auto& ys = cloud.points->getPointsBufferRef_y();
    const auto& zs = cloud.points->getPointsBufferRef_z();
    std::vector<RangeDot> dots;
    const std::size_t step =
        std::max<std::size_t>(1, cloud.size() / std::max<std::size_t>(1, style.max_points));
    for (std::size_t i = 0; i < cloud.size(); i += step) {
        const auto place = seen.place_of(i);
        if (!place || seen.hidden(i)) continue;
        dots.push_back({{static_cast<int>(place->column), static_cast<int>(place->row)},
                        place->depth,
                        std::sqrt(xs[i] * xs[i] + ys[i] * ys[i] + zs[i] * zs[i])});
    }
    if (dots.empty()) return picture;
    auto [low, high] =
        style.max_range > 0.0 ? std::pair(style.min_range, style.max_range) : usual_ranges(dots);
    low = std::max(low, 1e-3);
    high = std::max(high, 1.001 * low);

    const auto shade = shades();
    cv::Mat nearest(photo.size(), CV_32F, cv::Scalar(std::numeric_limits<float>::infinity()));
    const cv::Rect whole({}, photo.size());
    for (const RangeDot& dot : dots) {
        const double share = std::log(dot.range / low) / std::log(high / low);
        const auto i =
            static_cast<std::size_t>(std::lround(std::clamp(share, 0.0, 1.0) * (kShades - 1)));
        const cv::Rect square = whole & cv::Rect(dot.pixel.x - (style.point_px - 1) / 2,
                                                 dot.pixel.y - (style.point_px - 1) / 2,
                                                 style.point_px, style.point_px);
        for (int v = square.y; v < square.br().y; ++v)
            for (int u = square.x; u < square.br().x; ++u)
                if (dot.depth < nearest.at<float>(v, u)) {
                    nearest.at<float>(v, u) = dot.depth;
                    picture.at<cv::Vec3b>(v, u) = shade[i];
                }
    }
    draw_scale(picture, photo.rows, low, high, shade);
    return picture;
}

}  // namespace petal
