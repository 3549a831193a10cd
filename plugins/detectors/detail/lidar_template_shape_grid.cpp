// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "detectors/detail/lidar_template_shape.hpp"
#include "petal/calibration/angles.hpp"
#include "petal/calibration/polygon.hpp"

namespace petal {
namespace {

constexpr double kShapeCellShare = 0.02;  ///< of the lesser side
constexpr double kShapeAround = 0.6;      ///< of the lesser side: the grid goes on so far
constexpr double kUnlike = 0.02;  ///< of the lesser side: by what the shifts of two sides differ
constexpr double kShapeSameTurn = 1e-6;   ///< m
constexpr double kHalfDiagonal = 0.7072;  ///< of a square's side, rounded up

}  // namespace

void PlateShape::build_grid() {
    everything_.resize(primitives_.size());
    std::iota(everything_.begin(), everything_.end(), std::uint16_t{0});
    cell_ = kShapeCellShare * least_side();
    const double around = kShapeAround * least_side();
    grid_min_ = -Eigen::Vector2d(width_, height_) / 2.0 - Eigen::Vector2d::Constant(around);
    columns_ = static_cast<int>(std::ceil((width_ + 2.0 * around) / cell_));
    rows_ = static_cast<int>(std::ceil((height_ + 2.0 * around) / cell_));
    const double diagonal = cell_ * std::sqrt(2.0);
    std::vector<double> distances(primitives_.size());
    begins_.push_back(0);
    loop_begins_.push_back(0);
    for (std::size_t i = 0; i < loops_.size(); ++i)
        every_loop_.push_back(static_cast<std::uint16_t>(i));
    for (int row = 0; row < rows_; ++row)
        for (int column = 0; column < columns_; ++column) {
            const Eigen::Vector2d p = grid_min_ + cell_ * Eigen::Vector2d(column + 0.5, row + 0.5);
            for (std::size_t k = 0; k < primitives_.size(); ++k)
                distances[k] = nearest_of(p, &everything_[k], &everything_[k] + 1).inside;
            const double least = *std::min_element(distances.begin(), distances.end());
            inside_.push_back(is_material(p) ? least : -least);
            in_outline_.push_back(in_outline(p) ? distance_to_outline(p) : -distance_to_outline(p));
            for (std::size_t k = 0; k < primitives_.size(); ++k)
                if (distances[k] <= least + diagonal) nearest_.push_back(everything_[k]);
            for (std::uint16_t l = 0; l < loops_.size(); ++l)
                for (std::uint16_t k = loops_[l].first; k < loops_[l].last; ++k)
                    if (distances[k] <= least + diagonal + kUnlike * least_side()) {
                        nearest_loops_.push_back(l);
                        break;
                    }
            loop_begins_.push_back(static_cast<std::uint32_t>(nearest_loops_.size()));
            begins_.push_back(static_cast<std::uint32_t>(nearest_.size()));
        }
}

PlateShape::Edge PlateShape::edge(const Eigen::Vector2d& p) const {
    const std::size_t cell = cell_at(p);
    if (cell == kNoCell)
        return edge_of(p, everything_.data(), everything_.data() + everything_.size());
    Edge edge = nearest_of(p, nearest_.data() + begins_[cell], nearest_.data() + begins_[cell + 1]);
    if (!is_material_in(cell, p)) turn_over(edge);
    return edge;
}

bool PlateShape::is_material_in(std::size_t cell, const Eigen::Vector2d& p) const {
    // Distances differ by no more than places do.
    if (std::abs(inside_[cell]) > kHalfDiagonal * cell_) return inside_[cell] > 0.0;
    // A hole that holds the place has the nearest side of all, and so has an outline that does not.
    for (std::uint32_t k = loop_begins_[cell]; k < loop_begins_[cell + 1]; ++k) {
        const Loop& loop = loops_[nearest_loops_[k]];
        if (contains(loop, p) != loop.of_outline) return false;
    }
    return true;
}

int PlateShape::beyond(const Eigen::Vector2d& p, double band) const {
    const std::size_t cell = cell_at(p);
    if (cell != kNoCell) {
        const double least = band + kHalfDiagonal * cell_;
        if (inside_[cell] > least) return 1;
        if (inside_[cell] < -least) return -1;
    }
    const double inside = edge(p).inside;
    return inside > band ? 1 : inside < -band ? -1 : 0;
}

bool PlateShape::in_zone(const Eigen::Vector2d& p) const {
    const double limit = outline_counts_ ? -reach_ : rim_;
    // Distances differ by no more than places do.
    if (const std::size_t cell = cell_at(p);
        cell != kNoCell && std::abs(in_outline_[cell] - limit) > kHalfDiagonal * cell_)
        return in_outline_[cell] > limit;
    if (outline_counts_) return in_outline(p) || distance_to_polygon(outline_, p) <= reach_;
    return in_outline(p) && distance_to_polygon(outline_, p) >= rim_;
}

int PlateShape::find_symmetry() const {
    const auto same_after = [&](int quarters) {
        const Eigen::Matrix2d turn =
            Eigen::Rotation2D<double>(quarters * kPi / 2.0).toRotationMatrix();
        const auto found = [&](const Eigen::Vector2d& p, const auto& places) {
            return std::any_of(places.begin(), places.end(), [&](const Eigen::Vector2d& q) {
                return (turn * p - q).norm() < kShapeSameTurn;
            });
        };
        std::vector<Eigen::Vector2d> corners;
        for (const auto& hole : holes_) corners.insert(corners.end(), hole.begin(), hole.end());
        const auto all_found = [&](const std::vector<Eigen::Vector2d>& places) {
            return std::all_of(places.begin(), places.end(),
                               [&](const Eigen::Vector2d& p) { return found(p, places); });
        };
        return all_found(outline_) && all_found(corners) &&
               std::all_of(round_holes_.begin(), round_holes_.end(), [&](const auto& hole) {
                   return std::any_of(
                       round_holes_.begin(), round_holes_.end(), [&](const auto& other) {
                           return (turn * hole.centre - other.centre).norm() < kShapeSameTurn &&
                                  std::abs(hole.radius - other.radius) < kShapeSameTurn;
                       });
               });
    };
    if (same_after(1)) return 4;
    return same_after(2) ? 2 : 1;
}

}  // namespace petal
