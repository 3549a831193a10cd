// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulation/camera/lens.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "simulation/camera/rows.hpp"

namespace petal::simulation {
namespace {

/// The fourth power of the cosine of the angle off the axis.
double cosine4(const Eigen::Vector3d& direction) {
    const double square = direction.z() * direction.z() / direction.squaredNorm();
    return square * square;
}

/// An integral of the normal distribution function of `sigma`.
double integral(double x, double sigma) {
    constexpr double kSqrt2 = 1.4142135623730951, kSqrt2Pi = 2.5066282746310002;
    const double z = x / sigma;
    return 0.5 * x * std::erfc(-z / kSqrt2) + sigma / kSqrt2Pi * std::exp(-0.5 * z * z);
}

}  // namespace

Vignetting::Vignetting(const PixelRays& rays, int margin, double loss) : rays_(rays) {
    double least = 1.0;
    for (int row = margin; row < rays.rows() - margin; ++row)
        for (int column = margin; column < rays.columns() - margin; ++column)
            if (rays.exists(column, row))
                least = std::min(least, cosine4(rays.inside(column, row, 0.5, 0.5)));
    if (least < 1.0) scale_ = loss / (1.0 - least);
}

float Vignetting::left(int column, int row) const {
    if (!rays_.exists(column, row)) return 0.0F;
    const double off = 1.0 - cosine4(rays_.inside(column, row, 0.5, 0.5));
    return static_cast<float>(std::max(0.0, 1.0 - scale_ * off));
}

Blur::Blur(double sigma_px)
    : reach_(sigma_px > 0.0 ? static_cast<int>(std::ceil(4.0 * sigma_px)) : 0) {
    if (reach_ == 0) return;
    shares_.resize(2 * static_cast<std::size_t>(reach_) + 1);
    for (int cell = 0; cell < Pixel::kCells; ++cell) {
        const double from = static_cast<double>(cell) / Pixel::kCells - 0.5;
        const double to = from + 1.0 / Pixel::kCells;
        const auto before = [&](double x) {  // of the cell's light, what lands before x
            return (integral(x - from, sigma_px) - integral(x - to, sigma_px)) * Pixel::kCells;
        };
        const double whole = before(reach_ + 0.5) - before(-reach_ - 0.5);
        for (int offset = -reach_; offset <= reach_; ++offset)
            shares_.begin()[offset + reach_][static_cast<std::size_t>(cell)] =
                static_cast<float>((before(offset + 0.5) - before(offset - 0.5)) / whole);
    }
}

cv::Mat Blur::of(const cv::Mat& means, const std::vector<std::vector<Divided>>& divided,
                 const Run& run) const {
    if (reach_ == 0) return means;
    cv::Mat kernel(1, 2 * reach_ + 1, CV_32F);
    for (int offset = -reach_; offset <= reach_; ++offset) {
        float sum = 0.0F;
        for (const float of_cell : share(offset)) sum += of_cell;
        kernel.at<float>(0, offset + reach_) = sum / Pixel::kCells;
    }
    cv::Mat image;
    cv::sepFilter2D(means, image, CV_32F, kernel, kernel);

    constexpr float kArea = 1.0F / (Pixel::kCells * Pixel::kCells);
    for_rows(run, image.rows, [&](int row) {
        auto* const pixels = image.ptr<cv::Vec3f>(row);
        const int first = std::max(0, row - reach_);
        const int last = std::min(image.rows - 1, row + reach_);
        for (int from = first; from <= last; ++from) {
            const auto& down = share(row - from);
            for (const Divided& pixel : divided[static_cast<std::size_t>(from)]) {
                std::array<Eigen::Vector3f, Pixel::kCells> columns;
                columns.fill(Eigen::Vector3f::Zero());
                for (std::size_t i = 0; i < pixel.cells.size(); ++i)
                    columns[i % Pixel::kCells] += kArea * down[i / Pixel::kCells] * pixel.cells[i];
                const int left = std::max(-reach_, -pixel.column);
                const int right = std::min(reach_, image.cols - 1 - pixel.column);
                for (int offset = left; offset <= right; ++offset) {
                    const auto& across = share(offset);
                    Eigen::Vector3f sum = Eigen::Vector3f::Zero();
                    for (std::size_t i = 0; i < columns.size(); ++i) sum += across[i] * columns[i];
                    pixels[pixel.column + offset] += cv::Vec3f(sum.x(), sum.y(), sum.z());
                }
            }
        }
    });
    return image;
}

}  // namespace petal::simulation
