// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "filters/detail/range_noise.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "filters/detail/cell_window.hpp"
#include "petal/calibration/for_pieces.hpp"

namespace petal {
namespace {

constexpr std::size_t kPlaces = 4096;
constexpr std::uint32_t kFewestPoints = 12;
constexpr double kNearest = 1.0, kFarthest = 12.0;  // m
constexpr std::size_t kEnoughPlaces = 30;

struct Place {
    double range = 0.0;     ///< m, mean
    double variance = 0.0;  ///< m^2, scaled so that the median over places is unbiased
};

/// The inverse of the range to a plane is linear in the ray's direction, and so nearly in small
/// angles: a plane of any slope is fitted by three numbers.
std::optional<Place> measured(const AngularCells& cells, const CellWindow& window,
                              std::size_t cell) {
    std::uint32_t count = 0;
    window.for_spans(1, [&](std::uint32_t first, std::uint32_t last) { count += last - first; });
    if (count < kFewestPoints) return std::nullopt;
    const AngularPoint& origin = cells.points()[cells.begin(cell)];
    const double per_step = 1.0 / cells.step();
    const double inverse_there = 1.0 / static_cast<double>(origin.range);
    Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
    Eigen::Vector3d right = Eigen::Vector3d::Zero();
    double sum = 0.0, squares = 0.0;
    window.for_spans(1, [&](std::uint32_t first, std::uint32_t last) {
        for (std::uint32_t i = first; i < last; ++i) {
            const AngularPoint& p = cells.points()[i];
            const Eigen::Vector3d a(1.0, static_cast<double>(p.azimuth - origin.azimuth) * per_step,
                                    static_cast<double>(p.elevation - origin.elevation) * per_step);
            const double inverse = 1.0 / static_cast<double>(p.range) - inverse_there;
            normal += a * a.transpose();
            right += a * inverse;
            squares += inverse * inverse;
            sum += static_cast<double>(p.range);
        }
    });
    const Eigen::Vector3d solution = normal.ldlt().solve(right);
    const double residual = std::max(0.0, squares - solution.dot(right));
    const double freedom = static_cast<double>(count) - 3.0;
    Place place;
    place.range = sum / static_cast<double>(count);
    // Wilson and Hilferty: the median of a chi-square of n degrees is n (1 - 2 / (9 n))^3.
    place.variance =
        residual * std::pow(place.range, 4) / freedom / std::pow(1.0 - 2.0 / (9.0 * freedom), 3);
    return place;
}

}  // namespace

std::optional<double> range_noise(const AngularCells& cells, const Run& run) {
    const std::size_t stride = std::max<std::size_t>(1, cells.size() / kPlaces);
    std::vector<std::vector<Place>> places(cells.rows());
    for_pieces(run, cells.rows(), 1, [&](std::size_t row, std::size_t end) {
        for (; row < end; ++row) {
            CellWindow window(cells, row);
            const std::size_t first = (cells.row_begin(row) + stride - 1) / stride * stride;
            for (std::size_t cell = first; cell < cells.row_begin(row + 1); cell += stride) {
                window.move_to(cell);
                if (const auto place = measured(cells, window, cell)) places[row].push_back(*place);
            }
        }
    });
    std::vector<double> near, all;
    for (const auto& row : places)
        for (const Place& place : row) {
            if (!std::isfinite(place.variance)) continue;
            all.push_back(place.variance);
            if (place.range >= kNearest && place.range <= kFarthest) near.push_back(place.variance);
        }
    std::vector<double>& taken = near.size() < kEnoughPlaces ? all : near;
    if (taken.empty()) return std::nullopt;
    const auto middle = taken.begin() + static_cast<std::ptrdiff_t>(taken.size() / 2);
    std::nth_element(taken.begin(), middle, taken.end());
    return std::sqrt(*middle);
}

}  // namespace petal
