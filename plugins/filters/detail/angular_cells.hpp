// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <mrpt/maps/CPointsMapXYZI.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "petal/run.hpp"

namespace petal {

/// A point as its LiDAR sees it.
struct AngularPoint {
    float azimuth;    ///< rad, -pi to pi: 0 along x, positive towards y; good to 1e-6 rad
    float elevation;  ///< rad, -pi/2 to pi/2: positive towards z; good to 1e-6 rad
    float range;      ///< m
    std::uint32_t index;
};

/// Leaves new elements of a vector as they are: millions are written once, by all threads.
template <class T>
struct Unset : std::allocator<T> {
    template <class U>
    struct rebind {  // NOLINT: the standard library's name
        using other = Unset<U>;
    };
    template <class U>
    void construct(U* at) {
        ::new (static_cast<void*>(at)) U;
    }
};
using AngularPoints = std::vector<AngularPoint, Unset<AngularPoint>>;

/// Points for each rad x rad of azimuth and elevation that a point has around it (the median over
/// points, in cells of 1 deg); 0 where no point has a direction.
double angular_density(const mrpt::maps::CPointsMapXYZI& points);

/// Points sorted into cells of azimuth and elevation. Only cells that hold a point exist. They are
/// ordered by row (elevation), then by column (azimuth), and in a cell the points keep their order:
/// the result does not depend on the number of threads. Time and memory are linear in the points,
/// whatever the step. Rows and columns do not meet at azimuth +-pi, behind the sensor. A point
/// without a direction (a coordinate that is not finite; the origin) is left out.
class AngularCells {
   public:
    struct Cell {
        std::uint32_t column = 0;
        std::uint32_t begin = 0;  ///< of its points; they end where those of the next cell begin
    };
    static constexpr double kSmallestStep = 1e-4;  ///< rad; a smaller step is taken as this

    /// \param step of the cells, rad
    AngularCells(const mrpt::maps::CPointsMapXYZI& points, double step, const Run& run);

    double step() const { return step_; }
    /// The points that have a direction, cell by cell.
    const AngularPoints& points() const { return points_; }
    std::size_t rows() const { return rows_.size() - 1; }
    std::size_t size() const { return cells_.size() - 1; }  ///< cells
    /// A row's cells are [row_begin(row), row_begin(row + 1)).
    std::uint32_t row_begin(std::size_t row) const { return rows_[row]; }
    std::uint32_t column(std::size_t cell) const { return cells_[cell].column; }
    /// A cell's points are [begin(cell), begin(cell + 1)).
    std::uint32_t begin(std::size_t cell) const { return cells_[cell].begin; }
    std::uint32_t count(std::size_t cell) const { return begin(cell + 1) - begin(cell); }

   private:
    /// Points row by row, in their order. Gives where the rows begin.
    std::vector<std::uint32_t> sort_rows(const mrpt::maps::CPointsMapXYZI& points, const Run& run);
    /// Sorts the points of each row by column and lists the cells.
    void sort_columns(const std::vector<std::uint32_t>& begins, const Run& run);

    double step_;
    AngularPoints points_;
    std::vector<Cell> cells_;          ///< and one more, at the points' end
    std::vector<std::uint32_t> rows_;  ///< and one more, at the cells' end
};

}  // namespace petal
