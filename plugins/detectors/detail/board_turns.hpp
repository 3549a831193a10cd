// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <Eigen/Core>
#include <vector>

namespace petal {

/// A projective map from board coordinates (m) to ideal pinhole pixels.
using Homography = Eigen::Matrix3d;

/// The quarter turns about a board's middle that leave its points where some of them are: four for
/// a square board, two for an oblong one, one (none at all) for most others.
class BoardTurns {
   public:
    BoardTurns() = default;
    BoardTurns(const std::vector<Eigen::Vector2d>& points, const Eigen::Vector2d& center);

    /// Board to board, the identity first.
    const std::vector<Homography>& all() const { return turns_; }
    /// Whether no turn would let the board's x run more to the right in the image, and its y more
    /// down; `jacobian` is that of the map to the image at the board's middle.
    bool is_upright(const Eigen::Matrix2d& jacobian) const;

   private:
    std::vector<Homography> turns_{Homography::Identity()};
};

}  // namespace petal
