// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "detectors/detail/lidar_template_shape.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "petal/calibration/angles.hpp"
#include "petal/calibration/polygon.hpp"

namespace petal {
namespace {

constexpr double kRimShare = 0.08;  ///< of the board's lesser side: 40 mm of 500
constexpr double kRimToHole = 0.4;  ///< of the way from the outline to the nearest hole
constexpr int kEighths = 8;
constexpr double kProbe = 1e-6;  ///< m

double area_of(const std::vector<Eigen::Vector2d>& polygon) {
    double twice = 0.0;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const Eigen::Vector2d& a = polygon[i];
        const Eigen::Vector2d& b = polygon[(i + 1) % polygon.size()];
        twice += a.x() * b.y() - a.y() * b.x();
    }
    return std::abs(twice) / 2.0;
}

}  // namespace

PlateShape::PlateShape(const Target& target, Sides sides)
    : outline_(target.outline),
      holes_(target.holes),
      round_holes_(target.round_holes),
      hole_count_(target.holes.size() + target.round_holes.size()),
      thickness_(target.thickness) {
    Eigen::Vector2d low = outline_.front(), high = outline_.front();
    for (const auto& corner : outline_) {
        low = low.cwiseMin(corner);
        high = high.cwiseMax(corner);
    }
    middle_ = (low + high) / 2.0;
    width_ = high.x() - low.x();
    height_ = high.y() - low.y();
    for (auto& corner : outline_) {
        corner -= middle_;
        radius_ = std::max(radius_, corner.norm());
    }
    plate_area_ = area_of(outline_);
    rim_ = kRimShare * least_side();
    for (auto& hole : holes_) {
        for (auto& corner : hole) {
            corner -= middle_;
            rim_ = std::min(rim_, kRimToHole * distance_to_polygon(outline_, corner));
        }
        plate_area_ -= area_of(hole);
    }
    for (auto& hole : round_holes_) {
        hole.centre -= middle_;
        rim_ =
            std::min(rim_, kRimToHole * (distance_to_polygon(outline_, hole.centre) - hole.radius));
        plate_area_ -= kPi * hole.radius * hole.radius;
    }
    reach_ = kRimShare * least_side();
    outline_counts_ = sides == Sides::all || !has_holes();
    if (outline_counts_) add_polygon(outline_, true);
    for (const auto& hole : holes_) add_polygon(hole, false);
    for (const auto& hole : round_holes_) add_circle(hole);
    build_grid();
    symmetry_ = find_symmetry();
}

void PlateShape::add_polygon(const std::vector<Eigen::Vector2d>& polygon, bool outline) {
    const int first = static_cast<int>(side_lengths_.size());
    const int count = static_cast<int>(polygon.size());
    const std::size_t begin = primitives_.size();
    for (int i = 0; i < count; ++i) {
        const Eigen::Vector2d& a = polygon[static_cast<std::size_t>(i)];
        const Eigen::Vector2d& b = polygon[static_cast<std::size_t>((i + 1) % count)];
        Primitive side;
        side.of_outline = outline;
        side.a = a;
        side.b = b;
        side.side = first + i;
        side.inward = Eigen::Vector2d(a.y() - b.y(), b.x() - a.x()).normalized();
        const Eigen::Vector2d probe = 0.5 * (a + b) + kProbe * side.inward;
        if (inside_polygon(polygon, probe) != outline) side.inward = -side.inward;
        primitives_.push_back(side);
        side_lengths_.push_back((b - a).norm());
        opposite_.push_back(count % 2 == 0 ? first + (i + count / 2) % count : -1);
    }
    close_loop(begin, outline);
}

void PlateShape::close_loop(std::size_t first, bool outline) {
    Loop loop;
    loop.first = static_cast<std::uint16_t>(first);
    loop.last = static_cast<std::uint16_t>(primitives_.size());
    loop.of_outline = outline;
    if (!outline) loop.hole = static_cast<int>(loops_.size()) - (outline_counts_ ? 1 : 0);
    loop.convex = !primitives_[first].round;
    for (std::size_t i = first; i < primitives_.size(); ++i) {
        primitives_[i].loop = static_cast<std::uint16_t>(loops_.size());
        if (primitives_[i].round) continue;
        for (std::size_t j = first; j < primitives_.size(); ++j) {
            const double inside = primitives_[i].inward.dot(primitives_[j].a - primitives_[i].a);
            if (outline ? inside < -kProbe : inside > kProbe) loop.convex = false;
        }
    }
    loops_.push_back(loop);
    side_holes_.resize(side_lengths_.size(), loop.hole);
}

void PlateShape::add_circle(const Target::RoundHole& hole) {
    const int first = static_cast<int>(side_lengths_.size());
    Primitive circle;
    circle.round = true;
    circle.a = hole.centre;
    circle.b = {hole.radius, 0.0};
    circle.side = first;
    primitives_.push_back(circle);
    for (int i = 0; i < kEighths; ++i) {
        side_lengths_.push_back(2.0 * kPi * hole.radius / kEighths);
        opposite_.push_back(first + (i + kEighths / 2) % kEighths);
    }
    close_loop(primitives_.size() - 1, false);
}

bool PlateShape::in_outline(const Eigen::Vector2d& p) const {
    return inside_polygon(outline_, p);
}

double PlateShape::distance_to_outline(const Eigen::Vector2d& p) const {
    return distance_to_polygon(outline_, p);
}

int PlateShape::hole_at(const Eigen::Vector2d& p) const {
    int index = 0;
    for (const auto& hole : holes_) {
        if (inside_polygon(hole, p)) return index;
        ++index;
    }
    for (const auto& hole : round_holes_) {
        if ((p - hole.centre).squaredNorm() < hole.radius * hole.radius) return index;
        ++index;
    }
    return -1;
}

bool PlateShape::on_plate(const Eigen::Vector2d& p) const {
    return in_outline(p) && hole_at(p) < 0;
}

PlateShape::Edge PlateShape::nearest_of(const Eigen::Vector2d& p, const std::uint16_t* first,
                                        const std::uint16_t* last) const {
    Edge edge;
    edge.inside = std::numeric_limits<double>::infinity();
    for (; first != last; ++first) {
        const Primitive& primitive = primitives_[*first];
        Eigen::Vector2d away;
        double distance;
        int side = primitive.side;
        if (primitive.round) {
            const Eigen::Vector2d from = p - primitive.a;
            const double radius = from.norm();
            const Eigen::Vector2d unit =
                radius > 0.0 ? Eigen::Vector2d(from / radius) : Eigen::Vector2d::UnitX();
            distance = std::abs(radius - primitive.b.x());
            away = radius >= primitive.b.x() ? unit : Eigen::Vector2d(-unit);
            if (distance < edge.inside)
                side +=
                    static_cast<int>(std::floor(
                        std::atan2(unit.y(), unit.x()) / (2.0 * kPi) * kEighths + 0.5 + kEighths)) %
                    kEighths;
        } else {
            const Eigen::Vector2d along = primitive.b - primitive.a;
            const double t =
                std::clamp((p - primitive.a).dot(along) / along.squaredNorm(), 0.0, 1.0);
            away = p - (primitive.a + t * along);
            distance = away.norm();
            if (distance > 1e-9)
                away /= distance;
            else
                away = Eigen::Vector2d(-along.y(), along.x()).normalized();
        }
        if (distance >= edge.inside) continue;
        edge.inside = distance;
        edge.inward = away;
        edge.side = side;
    }
    return edge;
}

PlateShape::Edge PlateShape::edge_of(const Eigen::Vector2d& p, const std::uint16_t* first,
                                     const std::uint16_t* last) const {
    Edge edge = nearest_of(p, first, last);
    if (!is_material(p)) turn_over(edge);
    return edge;
}

bool PlateShape::is_material(const Eigen::Vector2d& p) const {
    return outline_counts_ ? on_plate(p) : hole_at(p) < 0;
}

bool PlateShape::contains(const Loop& loop, const Eigen::Vector2d& p) const {
    const auto hole = static_cast<std::size_t>(loop.hole);
    if (loop.of_outline) return in_outline(p);
    if (hole < holes_.size()) return inside_polygon(holes_[hole], p);
    const Target::RoundHole& round = round_holes_[hole - holes_.size()];
    return (p - round.centre).squaredNorm() < round.radius * round.radius;
}

bool PlateShape::is_round(int side) const {
    for (const Primitive& primitive : primitives_)
        if (primitive.round && side >= primitive.side && side < primitive.side + kEighths)
            return true;
    return false;
}

double PlateShape::share_along(int side, const Eigen::Vector2d& p) const {
    for (const Primitive& primitive : primitives_) {
        if (primitive.round) {
            if (side < primitive.side || side >= primitive.side + kEighths) continue;
            const Eigen::Vector2d from = p - primitive.a;
            const double turn =
                std::atan2(from.y(), from.x()) / (2.0 * kPi) * kEighths + 0.5 + kEighths;
            return turn - std::floor(turn);
        }
        if (side != primitive.side) continue;
        const Eigen::Vector2d along = primitive.b - primitive.a;
        return std::clamp((p - primitive.a).dot(along) / along.squaredNorm(), 0.0, 1.0);
    }
    return 0.0;
}

std::vector<PlateShape::SidePoint> PlateShape::along_sides(double step, double margin) const {
    std::vector<SidePoint> points;
    for (const Primitive& primitive : primitives_) {
        if (primitive.round) {
            const double radius = primitive.b.x();
            const int count = std::max(kEighths, static_cast<int>(2.0 * kPi * radius / step));
            for (int i = 0; i < count; ++i) {
                const double angle = 2.0 * kPi * (i + 0.5) / count;
                const Eigen::Vector2d unit(std::cos(angle), std::sin(angle));
                const int eighth =
                    static_cast<int>(std::floor(angle / (2.0 * kPi) * kEighths + 0.5)) % kEighths;
                points.push_back(
                    {primitive.a + radius * unit, unit, primitive.side + eighth, false});
            }
            continue;
        }
        const Eigen::Vector2d along = primitive.b - primitive.a;
        const double length = along.norm();
        if (length <= 2.0 * margin) continue;
        const Eigen::Vector2d unit = along / length;
        const Eigen::Vector2d& inward = primitive.inward;
        const int count = std::max(1, static_cast<int>((length - 2.0 * margin) / step));
        for (int i = 0; i < count; ++i)
            points.push_back(
                {primitive.a + unit * (margin + (length - 2.0 * margin) * (i + 0.5) / count),
                 inward, primitive.side, primitive.of_outline});
    }
    return points;
}

}  // namespace petal
