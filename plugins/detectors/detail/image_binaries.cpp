// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "detectors/detail/image_binaries.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <opencv2/imgproc.hpp>
#include <vector>

namespace petal {

namespace {

/// Levels that part the image's grey values into equal shares, each once.
std::vector<int> quantile_levels(const cv::Mat& grey, int count) {
    std::array<int, 256> histogram{};
    for (int y = 0; y < grey.rows; ++y) {
        const std::uint8_t* row = grey.ptr<std::uint8_t>(y);
        for (int x = 0; x < grey.cols; ++x) ++histogram[row[x]];
    }
    const double total = static_cast<double>(grey.cols) * grey.rows;
    std::vector<int> levels;
    double below = 0.0;
    int next = 1;
    for (int value = 0; value < 255; ++value) {
        below += histogram[static_cast<std::size_t>(value)];
        while (next <= count && below >= total * next / (count + 1)) {
            if (levels.empty() || levels.back() != value) levels.push_back(value);
            ++next;
        }
    }
    return levels;
}

/// Grey levels that neighbours differ by where nothing is to be seen: the median over the image.
int usual_difference(const cv::Mat& grey) {
    std::array<int, 256> histogram{};
    int total = 0;
    for (int y = 0; y < grey.rows; y += 2) {
        const std::uint8_t* row = grey.ptr<std::uint8_t>(y);
        for (int x = 0; x + 2 < grey.cols; x += 2, ++total)
            ++histogram[static_cast<std::size_t>(std::abs(row[x] - row[x + 2]))];
    }
    int difference = 0;
    for (int below = histogram[0]; 2 * below < total && difference < 255;)
        below += histogram[static_cast<std::size_t>(++difference)];
    return difference;
}

/// 1 sigma of what differs over a short distance, where nothing is to be seen: most of an image.
double smooth_noise(const cv::Mat& smooth, int apart) {
    std::vector<float> differences;
    for (int y = 0; y < smooth.rows; y += 4) {
        const float* row = smooth.ptr<float>(y);
        for (int x = 0; x + apart < smooth.cols; x += 4)
            differences.push_back(std::abs(row[x] - row[x + apart]));
    }
    if (differences.empty()) return 0.0;
    const auto middle = differences.begin() + static_cast<std::ptrdiff_t>(differences.size() / 2);
    std::nth_element(differences.begin(), middle, differences.end());
    return static_cast<double>(*middle) * 1.4826 / std::sqrt(2.0);
}

}  // namespace

double image_noise(const cv::Mat& grey) {
    cv::Mat values;
    grey.convertTo(values, CV_32F);
    // Rounding alone has a standard deviation of 1 / sqrt(12).
    return std::max(smooth_noise(values, 2), 1.0 / std::sqrt(12.0));
}

void visit_faint_binaries(const cv::Mat& grey, const std::function<void(const cv::Mat&)>& visit) {
    constexpr double kSigmas = 2.5;
    if (grey.cols < 32 || grey.rows < 32) return;
    cv::Mat values, smooth, mean, difference, binary;
    grey.convertTo(values, CV_32F);
    for (const double scale : {1.5, 3.0}) {
        cv::GaussianBlur(values, smooth, cv::Size(), scale);
        const double step =
            kSigmas * std::max(smooth_noise(smooth, static_cast<int>(4.0 * scale)), 0.05);
        for (const int fraction : {24, 10}) {
            const int window = std::max(5, std::max(grey.cols, grey.rows) / fraction) | 1;
            cv::boxFilter(smooth, mean, -1, cv::Size(window, window));
            cv::subtract(smooth, mean, difference);
            for (const double level : {-step, step}) {
                cv::compare(difference, cv::Scalar(level), binary, cv::CMP_GE);
                visit(binary);
            }
        }
    }
}

void visit_binaries(const cv::Mat& grey, int levels,
                    const std::function<void(const cv::Mat&)>& visit) {
    cv::Mat smooth, binary, mean;
    cv::GaussianBlur(grey, smooth, cv::Size(3, 3), 0.0);
    for (const int level : quantile_levels(smooth, levels)) {
        cv::threshold(smooth, binary, level, 255.0, cv::THRESH_BINARY);
        visit(binary);
    }
    // Darker than the surroundings by more than the noise, else every flat wall is full of
    // contours.
    const int noise = 2 * usual_difference(smooth) + 1;
    for (const int fraction : {64, 24, 10}) {
        const int window = std::max(5, std::max(grey.cols, grey.rows) / fraction) | 1;
        cv::boxFilter(smooth, mean, -1, cv::Size(window, window));
        cv::subtract(mean, cv::Scalar(noise), mean);
        cv::compare(smooth, mean, binary, cv::CMP_GE);
        visit(binary);
    }
}

}  // namespace petal
