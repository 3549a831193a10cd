// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "petal/calibration/target.hpp"

namespace petal {

/// Where the material of a target's plate ends: the sides of its outline and of its holes, polygons
/// and circles alike. All places are in the board's frame about middle(): x right, y down, metres.
class PlateShape {
   public:
    /// Which sides count: the holes' alone (the rim of a plate may stand on a floor), or all.
    enum class Sides { holes, all };

    /// What a place is to the nearest side that counts.
    struct Edge {
        double inside = 0.0;  ///< m: its distance, positive on the material
        Eigen::Vector2d inward = Eigen::Vector2d::UnitX();  ///< unit: where `inside` grows
        int side = 0;                                       ///< index, below side_count()
    };

    /// Sides::holes of a target without holes is Sides::all.
    PlateShape(const Target& target, Sides sides);

    /// `p` may lie anywhere; far off the board the answer is exact too, but slow.
    Edge edge(const Eigen::Vector2d& p) const;

    /// 1: deeper in the material than `band` (m, not negative); -1: farther than that off it; 0:
    /// between. The same as comparing edge().inside, but many times faster.
    int beyond(const Eigen::Vector2d& p, double band) const;

    /// The side that decides for a beam which passes the edges with unlike shifts and widths:
    /// `metric(inside, inward)` is how surely a place lies on the material by that side alone. A
    /// convex hole is where all its sides say so, so its surest side counts; of several holes (and
    /// the outline) the least sure. `inside` is then that of the side's line.
    template <class Metric>
    Edge edge_by(const Eigen::Vector2d& p, const Metric& metric) const;

    /// True on the plate: inside the outline and in no hole.
    bool on_plate(const Eigen::Vector2d& p) const;
    bool in_outline(const Eigen::Vector2d& p) const;
    double distance_to_outline(const Eigen::Vector2d& p) const;  ///< m, from either side
    /// The hole that holds `p` (polygonal ones first), or -1.
    int hole_at(const Eigen::Vector2d& p) const;
    /// Inside the outline and at least `rim()` from it, where only the holes tell hits from misses;
    /// where the outline counts: not farther than reach() from it.
    bool in_zone(const Eigen::Vector2d& p) const;

    bool has_holes() const { return hole_count_ > 0; }
    std::size_t hole_count() const { return hole_count_; }
    /// A straight side of a polygon, or an eighth of a circle.
    std::size_t side_count() const { return side_lengths_.size(); }
    /// Where along a side a place lies: 0 at one end, 1 at the other.
    double share_along(int side, const Eigen::Vector2d& p) const;
    bool is_round(int side) const;
    /// The hole whose side this is, as hole_at() counts them; -1: the outline's.
    int hole_of(int side) const { return side_holes_[static_cast<std::size_t>(side)]; }
    double side_length(std::size_t side) const { return side_lengths_[side]; }
    /// The side across the hole (or the board), which a shift moves against this one in a shift of
    /// the edges and with it in a shift of the board; -1 for none.
    int opposite(std::size_t side) const { return opposite_[side]; }

    const Eigen::Vector2d& middle() const { return middle_; }  ///< in the frame of Target
    double width() const { return width_; }
    double height() const { return height_; }
    double least_side() const { return std::min(width_, height_); }
    /// From the middle to the farthest corner of the outline.
    double radius() const { return radius_; }
    double rim() const { return rim_; }
    double reach() const { return reach_; }
    double plate_area() const { return plate_area_; }
    double thickness() const { return thickness_; }

    /// How many times a full turn about the middle maps the target onto itself: 1, 2 or 4.
    int symmetry() const { return symmetry_; }

    /// Points along a side, both ends left out by `margin`, `step` apart; and the direction into
    /// the material.
    struct SidePoint {
        Eigen::Vector2d at, inward;
        int side = 0;
        bool of_outline = false;
    };
    std::vector<SidePoint> along_sides(double step, double margin) const;

   private:
    struct Primitive {
        bool round = false, of_outline = false;
        Eigen::Vector2d a, b;  ///< ends; a circle: centre and (radius, 0)
        int side = 0;          ///< of a circle: its first eighth
        Eigen::Vector2d inward = Eigen::Vector2d::UnitX();  ///< of a straight one, unit
        std::uint16_t loop = 0;
    };
    /// A hole or the outline: a range of primitives.
    struct Loop {
        std::uint16_t first = 0, last = 0;
        bool convex = false, of_outline = false;
        int hole = -1;  ///< as hole_at() counts them; -1: the outline
    };
    bool contains(const Loop& loop, const Eigen::Vector2d& p) const;
    void close_loop(std::size_t first, bool outline);
    void add_polygon(const std::vector<Eigen::Vector2d>& polygon, bool outline);
    void add_circle(const Target::RoundHole& hole);
    /// The index of the cell that holds `p`, or that of none.
    static constexpr std::size_t kNoCell = static_cast<std::size_t>(-1);
    std::size_t cell_at(const Eigen::Vector2d& p) const {
        const Eigen::Vector2d at = (p - grid_min_) / cell_;
        const bool within = at.x() >= 0.0 && at.y() >= 0.0 && at.x() < columns_ && at.y() < rows_;
        return within ? cell_of(at) : kNoCell;
    }
    /// The index of the cell of a place that lies in the grid, in cells.
    std::size_t cell_of(const Eigen::Vector2d& at) const {
        return static_cast<std::size_t>(at.y()) * static_cast<std::size_t>(columns_) +
               static_cast<std::size_t>(at.x());
    }
    Edge edge_of(const Eigen::Vector2d& p, const std::uint16_t* first,
                 const std::uint16_t* last) const;
    /// The same as of a place on the material.
    Edge nearest_of(const Eigen::Vector2d& p, const std::uint16_t* first,
                    const std::uint16_t* last) const;
    static void turn_over(Edge& edge) {
        edge.inside = -edge.inside;
        edge.inward = -edge.inward;
    }
    /// Not off the plate, as far as the sides that count tell.
    bool is_material(const Eigen::Vector2d& p) const;
    /// The same by what is near the cell that holds `p`.
    bool is_material_in(std::size_t cell, const Eigen::Vector2d& p) const;
    void build_grid();
    int find_symmetry() const;

    std::vector<Eigen::Vector2d> outline_;
    std::vector<std::vector<Eigen::Vector2d>> holes_;
    std::vector<Target::RoundHole> round_holes_;
    std::vector<Primitive> primitives_;
    std::vector<double> side_lengths_;
    std::vector<int> opposite_, side_holes_;
    std::size_t hole_count_ = 0;
    Eigen::Vector2d middle_ = Eigen::Vector2d::Zero();
    double width_ = 0.0, height_ = 0.0, radius_ = 0.0, rim_ = 0.0, reach_ = 0.0, plate_area_ = 0.0,
           thickness_ = 0.0;
    int symmetry_ = 1;
    bool outline_counts_ = false;

    /// Cells over the board and some way around it: which primitives can be the nearest there.
    Eigen::Vector2d grid_min_ = Eigen::Vector2d::Zero();
    double cell_ = 0.0;
    int columns_ = 0, rows_ = 0;
    /// Of the middle of each cell: edge().inside, and the distance to the outline, positive inside.
    std::vector<double> inside_, in_outline_;
    std::vector<std::uint32_t> begins_;
    std::vector<std::uint16_t> nearest_;
    std::vector<std::uint32_t> loop_begins_;
    std::vector<std::uint16_t> nearest_loops_;
    std::vector<std::uint16_t> everything_;
    std::vector<Loop> loops_;
    std::vector<std::uint16_t> every_loop_;
};

template <class Metric>
PlateShape::Edge PlateShape::edge_by(const Eigen::Vector2d& p, const Metric& metric) const {
    const std::uint16_t* first = every_loop_.data();
    const std::uint16_t* last = first + every_loop_.size();
    if (const std::size_t cell = cell_at(p); cell != kNoCell) {
        first = nearest_loops_.data() + loop_begins_[cell];
        last = nearest_loops_.data() + loop_begins_[cell + 1];
    }
    Edge least;
    double least_sure = 0.0;
    bool any = false;
    for (; first != last; ++first) {
        const Loop& loop = loops_[*first];
        Edge chosen;
        double sure = 0.0;
        if (loop.convex) {
            for (std::uint16_t k = loop.first; k < loop.last; ++k) {
                const Primitive& side = primitives_[k];
                const double inside = side.inward.dot(p - side.a);
                const double by_side = metric(inside, side.inward);
                if (k > loop.first && (loop.of_outline ? by_side >= sure : by_side <= sure))
                    continue;
                sure = by_side;
                chosen = {inside, side.inward, side.side};
            }
        } else {
            const std::uint16_t* begin = &everything_[loop.first];
            chosen = edge_of(p, begin, begin + (loop.last - loop.first));
            sure = metric(chosen.inside, chosen.inward);
        }
        if (any && sure >= least_sure) continue;
        any = true;
        least_sure = sure;
        least = chosen;
    }
    return least;
}

}  // namespace petal
