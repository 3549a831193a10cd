// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "metrics/detail/plate_side_grid.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "petal/calibration/polygon.hpp"

namespace petal {
namespace {

constexpr double kAroundPlate = 0.1;    // m: rays beside a board pass within this
constexpr double kSmallestCell = 0.02;  // m: a few sides a cell, and a grid that costs little
constexpr double kMostCells = 100.0;    // along the longer side
constexpr double kRounding = 1e-9;      // m

}  // namespace

double distance_to(const PlateSide& side, const Eigen::Vector2d& p) {
    const double t =
        std::clamp((p - side.begin).dot(side.along) / side.along.squaredNorm(), 0.0, 1.0);
    return (side.begin + t * side.along - p).norm();
}

PlateSideGrid::PlateSideGrid(const std::vector<PlateRing>& rings) {
    Eigen::AlignedBox2d box;
    for (std::size_t r = 0; r < rings.size(); ++r) {
        const auto& corners = rings[r].corners;
        all_.rings.push_back(r);
        for (std::size_t i = 0; i < corners.size(); ++i) {
            box.extend(corners[i]);
            all_.sides.push_back(sides_.size());
            sides_.push_back({corners[i], corners[(i + 1) % corners.size()] - corners[i],
                              rings[r].first_edge + i});
        }
    }
    if (sides_.empty()) return;
    const Eigen::Vector2d size = box.sizes().array() + 2.0 * kAroundPlate;
    begin_ = box.min().array() - kAroundPlate;
    cell_ = std::max(kSmallestCell, size.maxCoeff() / kMostCells);
    columns_ = static_cast<std::size_t>(std::ceil(size.x() / cell_));
    rows_ = static_cast<std::size_t>(std::ceil(size.y() / cell_));
    cells_.reserve(columns_ * rows_);
    for (std::size_t row = 0; row < rows_; ++row)
        for (std::size_t column = 0; column < columns_; ++column)
            cells_.push_back(
                cell_about(begin_ + cell_ * Eigen::Vector2d(static_cast<double>(column) + 0.5,
                                                            static_cast<double>(row) + 0.5),
                           rings));
}

PlateSideGrid::Cell PlateSideGrid::cell_about(const Eigen::Vector2d& middle,
                                              const std::vector<PlateRing>& rings) const {
    const double half_diagonal = 0.5 * std::sqrt(2.0) * cell_ + kRounding;
    std::vector<double> distances;
    double nearest = std::numeric_limits<double>::infinity();
    for (const PlateSide& side : sides_) {
        distances.push_back(distance_to(side, middle));
        nearest = std::min(nearest, distances.back());
    }
    Cell cell;
    for (std::size_t i = 0; i < sides_.size(); ++i)
        if (!(distances[i] > nearest + 2.0 * half_diagonal)) cell.sides.push_back(i);
    std::size_t side = 0;
    for (std::size_t r = 0; r < rings.size(); ++r) {
        bool crosses = false;
        for (std::size_t i = 0; i < rings[r].corners.size(); ++i, ++side)
            crosses = crosses || !(distances[side] > half_diagonal);
        if (crosses)
            cell.rings.push_back(r);
        else if (inside_polygon(rings[r].corners, middle) == rings[r].hole)
            cell.on_plate = false;
    }
    return cell;
}

const PlateSideGrid::Cell& PlateSideGrid::at(const Eigen::Vector2d& p) const {
    const Eigen::Vector2d place = (p - begin_) / cell_;
    // Written so that NaN is outside too.
    const bool inside = place.x() >= 0.0 && place.y() >= 0.0 &&
                        place.x() < static_cast<double>(columns_) &&
                        place.y() < static_cast<double>(rows_);
    if (!inside) return all_;
    return cells_[static_cast<std::size_t>(place.y()) * columns_ +
                  static_cast<std::size_t>(place.x())];
}

}  // namespace petal
