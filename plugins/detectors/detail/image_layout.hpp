// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "detectors/detail/board_turns.hpp"
#include "petal/calibration/target.hpp"

namespace petal {

/// H applied to a board point. Only meaningful in front of the camera: the third coordinate is
/// positive.
Eigen::Vector2d map_point(const Homography& h, const Eigen::Vector2d& board);
/// d (image) / d (board point), px/m.
Eigen::Matrix2d map_jacobian(const Homography& h, const Eigen::Vector2d& board);
/// The least-squares affine map as a homography (at least 3 points), and the homography of at least
/// 4 points. None where the points lie on a line.
std::optional<Homography> fit_affine(const std::vector<Eigen::Vector2d>& board,
                                     const std::vector<Eigen::Vector2d>& image);
std::optional<Homography> fit_homography(const std::vector<Eigen::Vector2d>& board,
                                         const std::vector<Eigen::Vector2d>& image);

/// The target as the image detector needs it: holes with four corners, and which turns leave it as
/// it is.
class HoleLayout {
   public:
    /// A side of a hole, clockwise as seen from the front, and the corners that end it.
    struct Side {
        std::size_t hole = 0;
        Eigen::Vector2d from, to;                    ///< m
        std::size_t from_corner = 0, to_corner = 0;  ///< indices of corners()
    };

    /// \throws Error when a hole has not four corners, or there are fewer than two holes.
    explicit HoleLayout(const Target& target);

    const Target& target() const { return target_; }
    std::size_t holes() const { return target_.holes.size(); }
    /// Four corners, clockwise as seen from the front.
    const std::vector<Eigen::Vector2d>& hole(std::size_t i) const { return target_.holes[i]; }
    const Eigen::Vector2d& hole_center(std::size_t i) const { return centers_[i]; }
    const std::vector<Eigen::Vector2d>& corners() const { return corners_; }
    const std::vector<Side>& sides() const { return sides_; }
    /// The middle of the outline's bounding box.
    const Eigen::Vector2d& center() const { return center_; }
    /// Mean length of the hole sides, m.
    double hole_side() const { return hole_side_; }
    /// Points on the plate and points in the holes, each at least a tenth of a hole side off every
    /// edge.
    const std::vector<Eigen::Vector2d>& plate_points() const { return plate_points_; }
    const std::vector<Eigen::Vector2d>& hole_points() const { return hole_points_; }

    /// The same board, turned (by a turn that leaves the layout as it is) so that its x runs to the
    /// right in the image and its y down, as nearly as can be.
    Homography upright(const Homography& h) const;
    /// Whether no turn would make it more upright; `jacobian` is that of the map at the centre.
    bool is_upright(const Eigen::Matrix2d& jacobian) const { return turns_.is_upright(jacobian); }
    /// Seen from the front, whole, in front of the camera, not nearly edge on: the projected
    /// outline is convex and clockwise, and foreshortened to no less than `min_foreshortening`.
    bool plausible(const Homography& h, double min_foreshortening) const;

   private:
    void sample_points();

    Target target_;
    std::vector<Eigen::Vector2d> corners_;
    std::vector<Eigen::Vector2d> centers_;
    std::vector<Side> sides_;
    Eigen::Vector2d center_ = Eigen::Vector2d::Zero();
    double hole_side_ = 0.0;
    std::vector<Eigen::Vector2d> plate_points_;
    std::vector<Eigen::Vector2d> hole_points_;
    BoardTurns turns_;
};

}  // namespace petal
