// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "filters/detail/angular_cells.hpp"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "petal/calibration/angles.hpp"

namespace petal {
namespace {

constexpr auto kHalfTurn = static_cast<float>(kPi);
constexpr std::size_t kBlock = 16384;  ///< points that one task takes
constexpr std::size_t kMostBlocks = 64;

/// The angle of (x, y), like std::atan2 but without branches, so that compilers vectorise it: an
/// odd polynomial through the Chebyshev nodes of [0, 1], good to 6e-8, and the octants' symmetry.
float angle_of(float y, float x) {
    const float ax = std::abs(x);
    const float ay = std::abs(y);
    const float larger = std::max(ax, ay);
    const float t = std::min(ax, ay) / (larger > 0.0F ? larger : 1.0F);
    const float u = t * t;
    float p = -0.00455979199F;
    p = p * u + 0.0237805186F;
    p = p * u - 0.0588297531F;
    p = p * u + 0.0986886546F;
    p = p * u - 0.140032902F;
    p = p * u + 0.199669618F;
    p = p * u - 0.333318127F;
    p = p * u + 0.999999882F;
    float angle = p * t;
    angle = ay > ax ? 0.5F * kHalfTurn - angle : angle;
    angle = x < 0.0F ? kHalfTurn - angle : angle;
    return y < 0.0F ? -angle : angle;
}

AngularPoint angular(float x, float y, float z, std::size_t index) {
    const float across = std::sqrt(x * x + y * y);
    AngularPoint point;
    point.range = std::sqrt(x * x + y * y + z * z);
    // A sum of squares that is infinite or NaN tells of all three coordinates at once.
    if (!(point.range > 0.0F && point.range < std::numeric_limits<float>::infinity()))
        point.range = std::numeric_limits<float>::quiet_NaN();
    point.azimuth = angle_of(y, x);
    point.elevation = angle_of(z, across);
    point.index = static_cast<std::uint32_t>(index);
    return point;
}

/// body(first, last) over blocks of [0, size).
template <class Body>
void for_blocks(const Run& run, std::size_t size, std::size_t block, const Body& body) {
    tbb::task_arena arena(run.threads());
    arena.execute([&] {
        tbb::parallel_for(tbb::blocked_range<std::size_t>(0, size, block), [&](const auto& range) {
            if (!run.cancelled()) body(range.begin(), range.end());
        });
    });
    run.check_cancelled();
}

}  // namespace

std::vector<AngularPoint> angular_points(const mrpt::maps::CPointsMapXYZI& points, const Run& run) {
    const auto& xs = points.getPointsBufferRef_x();
    const auto& ys = points.getPointsBufferRef_y();
    const auto& zs = points.getPointsBufferRef_z();
    std::vector<AngularPoint> result(xs.size());
    for_blocks(run, result.size(), kBlock, [&](std::size_t first, std::size_t last) {
        for (std::size_t i = first; i < last; ++i) result[i] = angular(xs[i], ys[i], zs[i], i);
    });
    return result;
}

double angular_density(const std::vector<AngularPoint>& points) {
    constexpr float kCell = kHalfTurn / 180.0F;
    constexpr std::size_t kColumns = 362, kRows = 182;
    constexpr std::size_t kAsked = 200000;  // enough for a median of counts
    const std::size_t stride = std::max<std::size_t>(1, points.size() / kAsked);
    std::vector<std::uint32_t> counts(kColumns * kRows);
    std::size_t taken = 0;
    for (std::size_t i = 0; i < points.size(); i += stride) {
        const AngularPoint& p = points[i];
        if (std::isnan(p.range)) continue;
        const auto row =
            static_cast<std::size_t>(std::lround((p.elevation + 0.5F * kHalfTurn) / kCell));
        const auto column = static_cast<std::size_t>(std::lround((p.azimuth + kHalfTurn) / kCell));
        ++counts[std::min(row, kRows - 1) * kColumns + std::min(column, kColumns - 1)];
        ++taken;
    }
    std::sort(counts.begin(), counts.end());
    std::size_t below = 0;
    for (const std::uint32_t count : counts) {
        below += count;
        if (2 * below >= taken && taken > 0)
            return static_cast<double>(count) * static_cast<double>(stride) /
                   static_cast<double>(kCell * kCell);
    }
    return 0.0;
}

AngularCells::AngularCells(const std::vector<AngularPoint>& points, double step, const Run& run)
    : step_(std::max(step, kSmallestStep)) {
    sort_columns(sort_rows(points, run), run);
}

std::uint32_t AngularCells::row_of(const AngularPoint& point) const {
    return static_cast<std::uint32_t>((point.elevation + 0.5F * kHalfTurn) /
                                      static_cast<float>(step_));
}

std::uint32_t AngularCells::column_of(const AngularPoint& point) const {
    return static_cast<std::uint32_t>((point.azimuth + kHalfTurn) / static_cast<float>(step_));
}

std::vector<std::uint32_t> AngularCells::sort_rows(const std::vector<AngularPoint>& points,
                                                   const Run& run) {
    // A counting sort: each block of points counts its rows, a running sum over rows, then blocks,
    // gives every block its places, and each block puts its points there.
    const auto rows = static_cast<std::size_t>(kHalfTurn / static_cast<float>(step_)) + 2;
    const std::size_t blocks = std::clamp<std::size_t>(points.size() / kBlock, 1, kMostBlocks);
    const auto first_of = [&](std::size_t block) { return points.size() * block / blocks; };
    std::vector<std::uint32_t> places(blocks * rows);
    for_blocks(run, blocks, 1, [&](std::size_t first, std::size_t last) {
        for (std::size_t i = first_of(first); first < last; ++first)
            for (std::uint32_t* counts = &places[first * rows]; i < first_of(first + 1); ++i)
                if (!std::isnan(points[i].range)) ++counts[row_of(points[i])];
    });
    std::vector<std::uint32_t> begins(rows + 1);
    std::uint32_t sum = 0;
    for (std::size_t row = 0; row < rows; ++row) {
        begins[row] = sum;
        for (std::size_t block = 0; block < blocks; ++block)
            sum += std::exchange(places[block * rows + row], sum);
    }
    begins[rows] = sum;
    points_.resize(sum);
    for_blocks(run, blocks, 1, [&](std::size_t first, std::size_t last) {
        for (std::size_t i = first_of(first); first < last; ++first)
            for (std::uint32_t* place = &places[first * rows]; i < first_of(first + 1); ++i)
                if (!std::isnan(points[i].range)) points_[place[row_of(points[i])]++] = points[i];
    });
    return begins;
}

void AngularCells::sort_columns(const std::vector<std::uint32_t>& begins, const Run& run) {
    const std::size_t rows = begins.size() - 1;
    std::vector<std::vector<Cell>> cells(rows);
    for_blocks(run, rows, 1, [&](std::size_t first_row, std::size_t last_row) {
        std::vector<AngularPoint> sorted;
        std::vector<std::uint32_t> places;
        for (std::size_t row = first_row; row < last_row; ++row) {
            const auto first = points_.begin() + begins[row];
            const auto last = points_.begin() + begins[row + 1];
            if (first == last) continue;
            const auto size = static_cast<std::size_t>(last - first);
            const auto [least, most] = std::minmax_element(
                first, last, [](const auto& a, const auto& b) { return a.azimuth < b.azimuth; });
            const std::uint32_t base = column_of(*least);
            const std::size_t columns = column_of(*most) - base + 1;
            if (columns > 8 * size) {  // a row with few points: counting would not be linear
                std::stable_sort(first, last, [this](const auto& a, const auto& b) {
                    return column_of(a) < column_of(b);
                });
            } else {
                places.assign(columns + 1, 0);
                for (auto point = first; point != last; ++point)
                    ++places[column_of(*point) - base + 1];
                for (std::size_t i = 0; i < columns; ++i) places[i + 1] += places[i];
                sorted.resize(size);
                for (auto point = first; point != last; ++point)
                    sorted[places[column_of(*point) - base]++] = *point;
                std::copy(sorted.begin(), sorted.end(), first);
            }
            for (auto point = first; point != last; ++point) {
                const std::uint32_t column = column_of(*point);
                if (cells[row].empty() || cells[row].back().column != column)
                    cells[row].push_back(
                        {column, static_cast<std::uint32_t>(point - points_.begin())});
            }
        }
    });
    rows_.reserve(rows + 1);
    std::uint32_t count = 0;
    for (const auto& row : cells) {
        rows_.push_back(count);
        count += static_cast<std::uint32_t>(row.size());
    }
    rows_.push_back(count);
    cells_.reserve(count + std::size_t{1});
    for (const auto& row : cells) cells_.insert(cells_.end(), row.begin(), row.end());
    cells_.push_back({0, begins.back()});
}

}  // namespace petal
