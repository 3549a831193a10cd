// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <vector>

#include "metrics/detail/plate_side_grid.hpp"
#include "petal/calibration/target.hpp"

namespace petal {

/// The edges of a board's plate: each side of its outline and of its holes, and each quarter of a
/// round hole. Board frame of Target, m.
class PlateEdges {
   public:
    struct Edge {
        Eigen::Vector2d middle = Eigen::Vector2d::Zero();
        Eigen::Vector2d inward = Eigen::Vector2d::Zero();  ///< unit, from the edge into the plate
        bool of_outline = false;
    };
    /// A place near one edge and far from every corner.
    struct Place {
        std::size_t edge = 0;
        double inside = 0.0;  ///< distance from the edge, m; positive on the plate
        Eigen::Vector2d inward = Eigen::Vector2d::Zero();  ///< unit, at this place
    };

    explicit PlateEdges(const Target& target);

    const std::vector<Edge>& edges() const { return edges_; }
    double width() const { return width_; }
    double height() const { return height_; }
    /// The middle of the outline's bounding box.
    Eigen::Vector2d middle() const { return {0.5 * width_, 0.5 * height_}; }

    /// The nearest edge, where it is nearer than `band` and the place lies beside it, at least
    /// `from_corner` from its ends.
    std::optional<Place> near(const Eigen::Vector2d& p, double band, double from_corner) const;
    /// The signed distance to the nearest edge: positive on the plate.
    double inside(const Eigen::Vector2d& p) const;

   private:
    struct Round {
        Eigen::Vector2d centre = Eigen::Vector2d::Zero();
        double radius = 0.0;
        std::size_t first_edge = 0;
    };
    void add_ring(std::vector<Eigen::Vector2d> corners, bool hole);

    std::vector<Edge> edges_;
    std::vector<PlateRing> rings_;
    PlateSideGrid grid_;
    std::vector<Round> rounds_;
    double width_ = 0.0, height_ = 0.0;
};

/// A target whose outline and holes are `scale` times as large; its prints are left out.
Target scaled(Target target, double scale);

}  // namespace petal
