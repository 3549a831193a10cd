// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "detectors/detail/image_hole_sides.hpp"
#include "detectors/detail/image_layout.hpp"

namespace petal {

/// What the covariance needs to know of one side's line, in ideal px: it lies `offset` out of the
/// hole at its middle and further by `tilt` at its end (at its start: less).
struct MeasuredSide {
    /// Offset and tilt of its own points from where they were expected; weighted least squares.
    Eigen::Vector2d measured = Eigen::Vector2d::Zero();
    /// Sum over its points of w (1, u)^T (1, u), u = -1 to 1 along the side; zero for no points.
    Eigen::Matrix2d information = Eigen::Matrix2d::Zero();
    /// The share of `measured` that the line took over; the rest is the board's geometry.
    Eigen::Matrix2d gain = Eigen::Matrix2d::Zero();
};

/// A corner as the crossing of two lines: moves by d_corner = crossing * (d_1, d_2), d_k what line
/// `side[k]` moves outwards at the corner, which is its end (sign 1) or its start (sign -1).
struct CornerCrossing {
    std::size_t side[2] = {0, 0};
    double sign[2] = {1.0, 1.0};
    Eigen::Matrix2d crossing = Eigen::Matrix2d::Identity();    ///< ideal px
    Eigen::Matrix2d distortion = Eigen::Matrix2d::Identity();  ///< d (raw px) / d (ideal px)
};

/// The covariance of all corners together, 2N x 2N, raw px^2, u0 v0 u1 v1 ...
///
/// The homography was fitted to the points of all sides; each side's line is then its own points'
/// and the homography's prediction, mixed by `gain`. Both are linear in the sides' own offsets and
/// tilts, so their errors are carried through. What variance a point has is told by how the sides
/// lie about the homography (two figures each, less ten that were fitted): that holds what the
/// points of a side share - a side cut askew, pixels that neighbours have in common - and is never
/// taken below `scatter`^2, the variance of the points about their own lines. A side without
/// points is as far off the geometry as the others.
///
/// Holes that look smaller than the target's, beyond what HoleWalls took out, may still
/// do so because the plate's thickness shows. That makes the hole smaller and shifts it as much. So
/// the insets that are left, fitted for both axes, are in doubt as a common inset and as a common
/// shift; and so are the walls, by `wall_sigma` (m). `inset` (m) is what the sides' `measured` were
/// taken from.
Eigen::MatrixXd corner_covariance(const HoleLayout& layout, const Homography& h,
                                  const std::vector<MeasuredSide>& sides,
                                  const std::vector<CornerCrossing>& corners, double scatter,
                                  double inset, const std::vector<double>& wall_sigma);

}  // namespace petal
