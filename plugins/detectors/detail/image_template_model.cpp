// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "detectors/detail/image_template_model.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "petal/calibration/angles.hpp"
#include "petal/calibration/polygon.hpp"
#include "petal/error.hpp"

namespace petal {

namespace {

/// A round hole's rim is taken as so many arcs, each of which may be hidden by itself.
constexpr int kArcs = 8;

void add_polygon(const std::vector<Eigen::Vector2d>& polygon, bool outline, std::size_t contour,
                 std::vector<TemplateSide>& sides) {
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        TemplateSide side;
        side.outline = outline;
        side.contour = contour;
        side.from = polygon[i];
        side.to = polygon[(i + 1) % polygon.size()];
        sides.push_back(side);
    }
}

bool on_print(const Target& target, const Eigen::Vector2d& p, double margin) {
    const auto inside = [&](const Eigen::Vector2d& corner, double width, double height) {
        return p.x() > corner.x() - margin && p.x() < corner.x() + width + margin &&
               p.y() > corner.y() - margin && p.y() < corner.y() + height + margin;
    };
    for (const auto& marker : target.markers)
        if (inside(marker.corner, marker.size, marker.size)) return true;
    for (const auto& board : target.checkerboards)
        if (inside(board.corner, board.square * board.columns, board.square * board.rows))
            return true;
    return false;
}

}  // namespace

double TemplateSide::length() const {
    return radius > 0.0 ? radius * sweep : (to - from).norm();
}

Eigen::Vector2d TemplateSide::at(double t) const {
    if (radius <= 0.0) return from + t * (to - from);
    const double angle = begin + t * sweep;
    return centre + radius * Eigen::Vector2d(std::cos(angle), std::sin(angle));
}

Eigen::Vector2d TemplateSide::along(double t) const {
    if (radius <= 0.0) return (to - from).normalized();
    const double angle = begin + t * sweep;
    return {-std::sin(angle), std::cos(angle)};
}

Eigen::Vector2d TemplateSide::outwards(double t) const {
    // Clockwise with y down: what lies to the left of the way is outside.
    const Eigen::Vector2d way = along(t);
    return {way.y(), -way.x()};
}

double TemplateShape::roundness() const {
    return 16.0 * kPi * kPi * spread.determinant() / (area * area);
}

TemplateShape shape_of(const std::vector<Eigen::Vector2d>& polygon) {
    TemplateShape shape;
    shape.spread.setZero();
    const Eigen::Vector2d& origin = polygon.front();
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const Eigen::Vector2d a = polygon[i] - origin;
        const Eigen::Vector2d b = polygon[(i + 1) % polygon.size()] - origin;
        const double twice = a.x() * b.y() - a.y() * b.x();
        shape.area += 0.5 * twice;
        shape.center += twice / 6.0 * (a + b);
        shape.spread += twice / 24.0 *
                        (2.0 * a * a.transpose() + 2.0 * b * b.transpose() + a * b.transpose() +
                         b * a.transpose());
    }
    shape.center /= shape.area;
    shape.spread = shape.spread / shape.area - shape.center * shape.center.transpose();
    shape.center += origin;
    shape.area = std::abs(shape.area);
    return shape;
}

TemplateModel::TemplateModel(const Target& target) : target_(target), corners_(target.corners()) {
    if (target_.holes.empty() && target_.round_holes.empty())
        throw Error("target '" + target_.name + "' shows " + target_.features() +
                    "; image_template finds plates with holes: take another target or another "
                    "image_board_detector");
    Eigen::Vector2d low = target_.outline.front(), high = low;
    for (const auto& p : target_.outline) {
        low = low.cwiseMin(p);
        high = high.cwiseMax(p);
    }
    center_ = 0.5 * (low + high);
    plate_shape_ = shape_of(target_.outline);
    add_polygon(target_.outline, true, 0, sides_);
    add_holes();
    turns_ = BoardTurns(corners_, center_);
    double smallest = hole_shapes_.front().area;
    for (const TemplateShape& hole : hole_shapes_) smallest = std::min(smallest, hole.area);
    hole_size_ = std::sqrt(smallest);
    sample_plate();
}

void TemplateModel::add_holes() {
    for (const auto& hole : target_.holes) {
        hole_shapes_.push_back(shape_of(hole));
        add_polygon(hole, false, hole_shapes_.size(), sides_);
    }
    for (const auto& hole : target_.round_holes) {
        TemplateShape shape;
        shape.center = hole.centre;
        shape.area = kPi * hole.radius * hole.radius;
        shape.spread = 0.25 * hole.radius * hole.radius * Eigen::Matrix2d::Identity();
        hole_shapes_.push_back(shape);
        for (int i = 0; i < kArcs; ++i) {
            TemplateSide side;
            side.contour = hole_shapes_.size();
            side.centre = hole.centre;
            side.radius = hole.radius;
            side.sweep = 2.0 * kPi / kArcs;
            side.begin = i * side.sweep;
            side.from = side.at(0.0);
            side.to = side.at(1.0);
            sides_.push_back(side);
        }
    }
}

void TemplateModel::sample_plate() {
    const double margin = 0.12 * hole_size_;
    const double step = 0.15 * hole_size_;
    const Eigen::Vector2d half(0.5 * target_.width(), 0.5 * target_.height());
    for (double y = center_.y() - half.y(); y <= center_.y() + half.y(); y += step) {
        for (double x = center_.x() - half.x(); x <= center_.x() + half.x(); x += step) {
            const Eigen::Vector2d p(x, y);
            if (!inside_polygon(target_.outline, p) ||
                distance_to_polygon(target_.outline, p) < margin || on_print(target_, p, margin))
                continue;
            bool on_plate = true;
            for (const auto& hole : target_.holes)
                on_plate =
                    on_plate && !inside_polygon(hole, p) && distance_to_polygon(hole, p) >= margin;
            for (const auto& hole : target_.round_holes)
                on_plate = on_plate && (p - hole.centre).norm() >= hole.radius + margin;
            if (on_plate) plate_points_.push_back(p);
        }
    }
}

}  // namespace petal
