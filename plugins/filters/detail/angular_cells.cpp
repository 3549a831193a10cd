// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "filters/detail/angular_cells.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "filters/detail/direction_block.hpp"
#include "petal/calibration/angles.hpp"
#include "petal/calibration/for_pieces.hpp"

namespace petal {
namespace {

constexpr auto kHalfTurn = static_cast<float>(kPi);
constexpr std::size_t kTaskPoints = 16384;
constexpr std::size_t kMostTasks = 64;

/// Sorts a row's points, which keep their order within a column.
class RowSorter {
   public:
    explicit RowSorter(double step) : per_radian_(1.0F / static_cast<float>(step)) {}

    /// Gives the row's cells, with where they begin after `first`.
    std::vector<AngularCells::Cell> sort(AngularPoint* first, AngularPoint* last);

   private:
    void count(const AngularPoint* first, std::size_t columns);

    float per_radian_;
    std::vector<std::int32_t> columns_;  ///< of each point
    std::vector<std::uint32_t> places_;
    AngularPoints sorted_;
};

std::vector<AngularCells::Cell> RowSorter::sort(AngularPoint* first, AngularPoint* last) {
    const auto size = static_cast<std::size_t>(last - first);
    std::vector<AngularCells::Cell> cells;
    columns_.resize(size);
    for (std::size_t i = 0; i < size; ++i)
        columns_[i] = static_cast<std::int32_t>((first[i].azimuth + kHalfTurn) * per_radian_);
    std::int32_t least = columns_[0], most = columns_[0];
    for (const std::int32_t column : columns_) {
        least = std::min(least, column);
        most = std::max(most, column);
    }
    const auto columns = static_cast<std::size_t>(most - least) + 1;
    sorted_.resize(size);
    if (columns > 8 * size) {  // few points: counting would not be linear in them
        places_.resize(size);
        for (std::size_t i = 0; i < size; ++i) places_[i] = static_cast<std::uint32_t>(i);
        std::sort(places_.begin(), places_.end(), [this](std::uint32_t a, std::uint32_t b) {
            return columns_[a] != columns_[b] ? columns_[a] < columns_[b] : a < b;
        });
        for (std::size_t i = 0; i < size; ++i) {
            const auto column = static_cast<std::uint32_t>(columns_[places_[i]]);
            if (cells.empty() || cells.back().column != column)
                cells.push_back({column, static_cast<std::uint32_t>(i)});
            sorted_[i] = first[places_[i]];
        }
    } else {
        places_.assign(columns, 0);
        for (const std::int32_t column : columns_)
            ++places_[static_cast<std::size_t>(column - least)];
        std::uint32_t sum = 0;
        for (std::size_t i = 0; i < columns; ++i) {
            const std::uint32_t begin = sum;
            if (places_[i] > 0)
                cells.push_back(
                    {static_cast<std::uint32_t>(least) + static_cast<std::uint32_t>(i), begin});
            sum += std::exchange(places_[i], begin);
        }
        for (std::size_t i = 0; i < size; ++i)
            sorted_[places_[static_cast<std::size_t>(columns_[i] - least)]++] = first[i];
    }
    std::copy(sorted_.begin(), sorted_.end(), first);
    return cells;
}

}  // namespace

double angular_density(const mrpt::maps::CPointsMapXYZI& points) {
    constexpr float kCell = kHalfTurn / 180.0F;
    constexpr std::size_t kColumns = 362, kRows = 182;
    constexpr std::size_t kAsked = 200000;  // enough for a median of counts
    const std::size_t stride = std::max<std::size_t>(1, points.size() / kAsked);
    mrpt::maps::CPointsMapXYZI asked;
    asked.resize((points.size() + stride - 1) / stride);
    for (std::size_t i = 0; i < asked.size(); ++i)
        asked.setPointFast(i, points.getPointsBufferRef_x()[i * stride],
                           points.getPointsBufferRef_y()[i * stride],
                           points.getPointsBufferRef_z()[i * stride]);
    std::vector<std::uint32_t> counts(kColumns * kRows);
    std::size_t taken = 0;
    DirectionBlock block;
    for (std::size_t first = 0; first < asked.size(); first += DirectionBlock::kSize) {
        const std::size_t last = std::min(first + DirectionBlock::kSize, asked.size());
        block.set(asked, first, last);
        block.set_azimuths();
        for (std::size_t k = 0; k < last - first; ++k) {
            if (!block.has_direction(k)) continue;
            const auto row = static_cast<std::size_t>(
                std::lround((block.elevation(k) + 0.5F * kHalfTurn) / kCell));
            const auto column =
                static_cast<std::size_t>(std::lround((block.azimuth(k) + kHalfTurn) / kCell));
            ++counts[std::min(row, kRows - 1) * kColumns + std::min(column, kColumns - 1)];
            ++taken;
        }
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

AngularCells::AngularCells(const mrpt::maps::CPointsMapXYZI& points, double step, const Run& run)
    : step_(std::max(step, kSmallestStep)) {
    sort_columns(sort_rows(points, run), run);
}

std::vector<std::uint32_t> AngularCells::sort_rows(const mrpt::maps::CPointsMapXYZI& points,
                                                   const Run& run) {
    // A counting sort: each task counts the rows of its points, a running sum over rows, then
    // tasks, gives every task its places, and each task puts its points there. Directions are
    // computed in both passes: that is cheaper than to write them down and read them again.
    const float per_radian = 1.0F / static_cast<float>(step_);
    const auto rows = static_cast<std::size_t>(kHalfTurn * per_radian) + 2;
    const std::size_t tasks = std::clamp<std::size_t>(points.size() / kTaskPoints, 1, kMostTasks);
    const auto first_of = [&](std::size_t task) { return points.size() * task / tasks; };
    std::vector<std::uint32_t> places(tasks * rows);
    // visit(task's places, index of the first point in the block, k in the block, row)
    const auto for_rows = [&](bool azimuths, const auto& visit) {
        for_pieces(run, tasks, 1, [&](std::size_t task, std::size_t end) {
            DirectionBlock block;
            for (; task < end; ++task)
                for (std::size_t i = first_of(task); i < first_of(task + 1);
                     i += DirectionBlock::kSize) {
                    const std::size_t last =
                        std::min(i + DirectionBlock::kSize, first_of(task + 1));
                    block.set(points, i, last);
                    if (azimuths) block.set_azimuths();
                    for (std::size_t k = 0; k < last - i; ++k) {
                        if (!block.has_direction(k)) continue;
                        const auto row = static_cast<std::size_t>(
                            (block.elevation(k) + 0.5F * kHalfTurn) * per_radian);
                        visit(places[task * rows + row], block, k, i);
                    }
                }
        });
    };
    for_rows(false, [](std::uint32_t& count, const DirectionBlock&, std::size_t, std::size_t) {
        ++count;
    });
    std::vector<std::uint32_t> begins(rows + 1);
    std::uint32_t sum = 0;
    for (std::size_t row = 0; row < rows; ++row) {
        begins[row] = sum;
        for (std::size_t task = 0; task < tasks; ++task)
            sum += std::exchange(places[task * rows + row], sum);
    }
    begins[rows] = sum;
    points_.resize(sum);
    for_rows(true, [this](std::uint32_t& place, const DirectionBlock& block, std::size_t k,
                          std::size_t first) {
        points_[place++] = {block.azimuth(k), block.elevation(k), block.range(k),
                            static_cast<std::uint32_t>(first + k)};
    });
    return begins;
}

void AngularCells::sort_columns(const std::vector<std::uint32_t>& begins, const Run& run) {
    const std::size_t rows = begins.size() - 1;
    std::vector<std::vector<Cell>> cells(rows);
    for_pieces(run, rows, 1, [&](std::size_t row, std::size_t end) {
        RowSorter sorter(step_);
        for (; row < end; ++row) {
            if (begins[row] == begins[row + 1]) continue;
            cells[row] =
                sorter.sort(points_.data() + begins[row], points_.data() + begins[row + 1]);
            for (Cell& cell : cells[row]) cell.begin += begins[row];
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
