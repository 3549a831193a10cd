// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "detectors/detail/board_turns.hpp"
#include "petal/calibration/target.hpp"

namespace petal {

/// A straight side or an arc of the plate's edge: of its outline or of a hole. Board frame, m.
struct TemplateSide {
    bool outline = false;
    std::size_t contour =
        0;  ///< 0 for the outline, then the holes: polygons first, then round ones
    Eigen::Vector2d from = Eigen::Vector2d::Zero(), to = Eigen::Vector2d::Zero();
    double radius =
        0.0;  ///< of an arc about `centre`, clockwise from angle `begin` by `sweep`; 0: straight
    Eigen::Vector2d centre = Eigen::Vector2d::Zero();
    double begin = 0.0, sweep = 0.0;  ///< rad

    double length() const;                  ///< m
    Eigen::Vector2d at(double t) const;     ///< t from 0 to 1
    Eigen::Vector2d along(double t) const;  ///< unit tangent
    /// Unit normal: out of a hole onto the plate, or out of the plate.
    Eigen::Vector2d outwards(double t) const;
};

/// What a region of the plane looks like up to an affine map, by its moments.
struct TemplateShape {
    Eigen::Vector2d center = Eigen::Vector2d::Zero();  ///< m
    Eigen::Matrix2d spread =
        Eigen::Matrix2d::Identity();  ///< second central moments over the area, m^2
    double area = 0.0;                ///< m^2
    /// 16 pi^2 det(spread) / area^2, which no affine map changes: 1 for an ellipse, 1.097 for a
    /// parallelogram, 1.46 for a triangle.
    double roundness() const;
};

/// The moments of a simple polygon.
TemplateShape shape_of(const std::vector<Eigen::Vector2d>& polygon);

/// The plate with its outline and holes of any shape, as the image detector needs it.
class TemplateModel {
   public:
    /// \throws Error when the target has no hole.
    explicit TemplateModel(const Target& target);

    const Target& target() const { return target_; }
    const std::vector<TemplateSide>& sides() const { return sides_; }
    std::size_t holes() const { return hole_shapes_.size(); }
    const TemplateShape& hole(std::size_t i) const { return hole_shapes_[i]; }
    const TemplateShape& plate() const { return plate_shape_; }
    const std::vector<Eigen::Vector2d>& corners() const { return corners_; }
    /// The middle of the outline's bounding box, m.
    const Eigen::Vector2d& center() const { return center_; }
    const BoardTurns& turns() const { return turns_; }
    /// Root of the smallest hole's area, m: what "a hole's size" means.
    double hole_size() const { return hole_size_; }
    /// Points of the plate, off its edges and prints.
    const std::vector<Eigen::Vector2d>& plate_points() const { return plate_points_; }

   private:
    void add_holes();
    void sample_plate();

    Target target_;
    std::vector<TemplateSide> sides_;
    std::vector<TemplateShape> hole_shapes_;
    TemplateShape plate_shape_;
    std::vector<Eigen::Vector2d> corners_;
    Eigen::Vector2d center_ = Eigen::Vector2d::Zero();
    BoardTurns turns_;
    double hole_size_ = 0.0;
    std::vector<Eigen::Vector2d> plate_points_;
};

}  // namespace petal
