// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

namespace petal {

/// A closed line of a plate: its outline, or a hole.
struct PlateRing {
    std::vector<Eigen::Vector2d> corners;
    bool hole = false;
    std::size_t first_edge = 0;
};

/// A side of a ring: `begin` + t `along`, t from 0 to 1.
struct PlateSide {
    Eigen::Vector2d begin = Eigen::Vector2d::Zero();
    Eigen::Vector2d along = Eigen::Vector2d::Zero();
    std::size_t edge = 0;
};

/// What of a plate matters at a place: a grid of cells about the plate tells the few sides that may
/// be the nearest one there. Hundreds of thousands of rays ask, of a target of 20 sides. What is
/// left out cannot change an answer: it is that of all sides, to the last bit.
class PlateSideGrid {
   public:
    struct Cell {
        std::vector<std::size_t> sides;  ///< in the order of all sides
        std::vector<std::size_t> rings;  ///< on whose inside a place in the cell lies or not
        bool on_plate = true;            ///< as far as the other rings tell
    };

    PlateSideGrid() = default;
    explicit PlateSideGrid(const std::vector<PlateRing>& rings);

    const std::vector<PlateSide>& sides() const { return sides_; }
    const Cell& at(const Eigen::Vector2d& p) const;

   private:
    Cell cell_about(const Eigen::Vector2d& middle, const std::vector<PlateRing>& rings) const;

    std::vector<PlateSide> sides_;
    Eigen::Vector2d begin_ = Eigen::Vector2d::Zero();
    double cell_ = 1.0;  ///< m
    std::size_t columns_ = 0, rows_ = 0;
    std::vector<Cell> cells_;  ///< row by row
    Cell all_;                 ///< for places outside the grid
};

/// The distance of a place from a side.
double distance_to(const PlateSide& side, const Eigen::Vector2d& p);

}  // namespace petal
