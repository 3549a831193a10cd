// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "filters/detail/angular_cells.hpp"

namespace petal {

/// The cells around a cell, found by walking along five rows at once: moving on through a row costs
/// little, and nothing is looked up.
class CellWindow {
   public:
    static constexpr int kReach = 2;  ///< cells to each side
    static constexpr std::uint32_t kNone = 0xFFFFFFFFU;

    CellWindow(const AngularCells& cells, std::size_t row) : cells_(cells) {
        for (int dy = -kReach; dy <= kReach; ++dy) {
            const auto other = static_cast<std::ptrdiff_t>(row) + dy;
            if (other < 0 || other >= static_cast<std::ptrdiff_t>(cells.rows())) continue;
            next_[at(dy)] = cells.row_begin(static_cast<std::size_t>(other));
            end_[at(dy)] = cells.row_begin(static_cast<std::size_t>(other) + 1);
        }
    }

    /// \param cell in the row; not before the one of the call before.
    void move_to(std::size_t cell) {
        const auto column = static_cast<std::int64_t>(cells_.column(cell));
        for (int dy = -kReach; dy <= kReach; ++dy) {
            std::uint32_t& next = next_[at(dy)];
            const std::uint32_t end = end_[at(dy)];
            while (next < end && cells_.column(next) < column - kReach) ++next;
            auto& row = found_[at(dy)];
            row.fill(kNone);
            for (std::uint32_t c = next; c < end && cells_.column(c) <= column + kReach; ++c)
                row[static_cast<std::size_t>(cells_.column(c) - column + kReach)] = c;
        }
    }

    /// The cell so many columns and rows off, or kNone where there is no point.
    std::uint32_t cell(int dx, int dy) const { return found_[at(dy)][at(dx)]; }

    /// visit(first, last): the points of the cells up to `reach` off, in spans that are as long as
    /// can be.
    template <class Visit>
    void for_spans(int reach, const Visit& visit) const {
        for (int dy = -reach; dy <= reach; ++dy) {
            std::uint32_t first = kNone, last = kNone;
            for (int dx = -reach; dx <= reach; ++dx) {
                if (cell(dx, dy) == kNone) continue;
                if (first == kNone) first = cell(dx, dy);
                last = cell(dx, dy);
            }
            // Cells of a row follow each other: so do their points.
            if (first != kNone) visit(cells_.begin(first), cells_.begin(last + 1));
        }
    }

   private:
    static constexpr std::size_t kSide = 2 * kReach + 1;
    static std::size_t at(std::int64_t offset) { return static_cast<std::size_t>(offset + kReach); }

    const AngularCells& cells_;
    std::array<std::uint32_t, kSide> next_{}, end_{};
    std::array<std::array<std::uint32_t, kSide>, kSide> found_{};
};

}  // namespace petal
