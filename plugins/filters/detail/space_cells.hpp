// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "petal/calibration/cloud.hpp"
#include "petal/run.hpp"

namespace petal {

/// Points sorted into cubes of space: point p lies in cell floor(p / edge), along each axis. Built
/// by sorting; only cells that hold a point exist.
class SpaceCells {
   public:
    struct Point {
        float x, y, z;
        std::uint32_t index;  ///< in the cloud
    };
    /// The points of a cell, in the cloud's order.
    struct Points {
        const Point* first = nullptr;
        const Point* last = nullptr;
        const Point* begin() const { return first; }
        const Point* end() const { return last; }
        std::size_t size() const { return static_cast<std::size_t>(last - first); }
    };
    /// Finds the cells around one cell after the other.
    class Around;

    /// Sorts the points with these indices, whose coordinates are finite, on the run's threads.
    /// Cells more than 2^30 from the origin along an axis are one with the last that is not.
    SpaceCells(const Cloud& cloud, const std::vector<std::uint32_t>& indices, double edge,
               const Run& run);

    std::size_t size() const { return cells_.size(); }
    Points points(std::size_t cell) const;

   private:
    using Place = std::array<std::int32_t, 3>;
    struct Cell {
        Place place;
        std::uint32_t begin;  ///< of its points in points_
    };

    std::vector<Cell> cells_;    ///< ordered by place
    std::vector<Point> points_;  ///< cell by cell
};

class SpaceCells::Around {
   public:
    /// Looks at most `reach` cells away along each axis. `cells` outlives it.
    Around(const SpaceCells& cells, int reach);

    /// The points of the cells around, those of the cell itself left out, in a fixed order; valid
    /// until the next call. Cells are asked for in ascending order: as the cells are sorted, what
    /// was found for the last one leads to the next, without a search.
    const std::vector<Points>& of(std::size_t cell);

   private:
    const SpaceCells* cells_;
    std::int32_t reach_;
    std::vector<std::size_t> next_;  ///< for each column along z, where the last one was found
    std::vector<Points> found_;
};

}  // namespace petal
