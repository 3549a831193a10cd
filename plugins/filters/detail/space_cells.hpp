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
    /// Some points, as indices into the cloud, ascending.
    struct Points {
        const std::uint32_t* first = nullptr;
        const std::uint32_t* last = nullptr;
        const std::uint32_t* begin() const { return first; }
        const std::uint32_t* end() const { return last; }
        std::size_t size() const { return static_cast<std::size_t>(last - first); }
    };

    /// Sorts the points with these indices, whose coordinates are finite, on the run's threads.
    /// Cells more than 2^30 from the origin along an axis are one with the last that is not.
    SpaceCells(const Cloud& cloud, const std::vector<std::uint32_t>& indices, double edge,
               const Run& run);

    std::size_t size() const { return cells_.size(); }
    Points points(std::size_t cell) const;

    /// The points of the cell and of all that are at most `reach` cells away along each axis, those
    /// of the cell itself left out, in a fixed order; `found` is cleared first.
    void around(std::size_t cell, int reach, std::vector<Points>& found) const;

   private:
    struct Cell {
        std::array<std::int32_t, 3> place;
        std::uint32_t begin;  ///< of its points in order_
    };

    std::vector<Cell> cells_;           ///< ordered by place
    std::vector<std::uint32_t> order_;  ///< indices into the cloud, cell by cell
};

}  // namespace petal
