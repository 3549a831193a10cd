// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <mrpt/img/TCamera.h>

#include <Eigen/Core>
#include <array>
#include <vector>

#include "detectors/detail/image_hole_sides.hpp"
#include "detectors/detail/image_layout.hpp"
#include "detectors/detail/image_wall_prior.hpp"

namespace petal {

/// The walls of the holes, as thick as the plate. Seen obliquely, one of two opposite walls shows,
/// nearly as bright as the front; then the dark of the hole begins at the back edge, and the whole
/// hole looks shifted, towards the foot of the camera on the board.
class HoleWalls {
   public:
    HoleWalls(const HoleLayout& layout, const mrpt::img::TCamera& camera)
        : layout_(layout), camera_(camera) {}

    /// How far into the hole each side's back edge appears in the plane of the front, m; 0 where
    /// the wall does not show. One for each of HoleLayout::sides().
    std::vector<double> shown(const Homography& board_to_ideal) const;

    /// 0 for sides that stand left and right of a hole, 1 for those above and below.
    int axis(std::size_t side) const;

    /// How much of `shown` an edge in the image moves: (wall - hole) / (front - hole) in
    /// brightness, 1 for a wall as bright as the front.
    using Share = WallShare;
    /// How the board looks: (front - hole) / front in grey values, and its scale.
    struct Sight {
        double contrast = 1.0, px_per_m = 1.0;
    };

    /// The share of both axes: what one expects of a wall of the front's colour under another
    /// light, and what makes the holes as wide as the target says, each with its weight. Where
    /// walls show little, holes that look small say little of them. `insets` (m) is how much
    /// smaller the holes look at each side than `explained`; sides that were not measured are not
    /// used.
    std::array<Share, 2> share(const std::vector<double>& shown,
                               const std::array<Share, 2>& explained,
                               const std::vector<double>& insets, const std::vector<bool>& measured,
                               const Sight& sight) const;

   private:
    const HoleLayout& layout_;
    const mrpt::img::TCamera& camera_;
};

}  // namespace petal
