// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "detectors/detail/image_edge_sampler.hpp"
#include "detectors/detail/image_hole_sides.hpp"
#include "detectors/detail/image_layout.hpp"
#include "petal/calibration/camera_model.hpp"

namespace petal {

struct RefinementLimits {
    bool model_walls = false;    ///< the plate's thickness shows in the holes
    double tolerance = 0.001;    ///< m, 1 sigma: how straight and in place the hole sides are cut
    double min_contrast = 0.15;  ///< (plate - holes) / plate
    double min_plate_fraction =
        0.85;                        ///< plate points brighter than midway between plate and holes
    double min_hole_fraction = 0.6;  ///< hole points darker than that
    int min_sides = 12;            ///< of all hole sides, those that an edge in the image confirms
    double sigma_floor_px = 0.05;  ///< px, of a corner in each direction
};

struct RefinedBoard {
    Homography board_to_image = Homography::Identity();  ///< m to ideal pixels
    std::vector<Eigen::Vector2d> corners;                ///< raw pixels, Target::corners() order
    std::vector<Eigen::Matrix2d> covariance;             ///< px^2
    Eigen::MatrixXd joint_covariance;                    ///< of all corners, 2N x 2N, px^2
    std::vector<bool> side_measured;                     ///< HoleLayout::sides() order
    int sides_measured = 0;
    double hole_inset = 0.0;  ///< m: how much smaller than the target's the holes are, on each side
    /// m: how much further into the hole each side's edge is seen than the front edge lies, since
    /// the wall of the hole shows. HoleLayout::sides() order.
    std::vector<double> wall;
    std::vector<double> wall_sigma;  ///< m, 1 sigma of it; of all sides of an axis together
    double line_rms_px = 0.0;        ///< edge points about the lines of their sides
    double board_rms_px = 0.0;       ///< measured sides about the board's geometry
    double contrast = 0.0;
    double plate_fraction = 0.0;
    std::string rejected;  ///< empty: a board; else why not, with figure and threshold
};

/// Turns a rough homography into corners, and says whether the image bears the board out.
///
/// One homography is fitted to the edge points of all hole sides at once (iteratively reweighted,
/// in ideal pixels); a side that does not lie where the others put it is no edge of this board but
/// something behind it, and is taken from the homography. The holes of a board may all be a little
/// smaller or larger than the target says (cut so, or its bright plate blooms): one common inset is
/// fitted too. Where the plate's thickness shows as a wall of the hole, the edges seen are those of
/// its back: their shift is taken out (HoleWalls). Each side's line is then its own edge points'
/// with this geometry as the prior (as wide as `tolerance`); corners are intersections of those
/// lines, in raw pixels.
class BoardRefiner {
   public:
    BoardRefiner(const EdgeSampler& edges, const HoleLayout& layout, const CameraModel& camera,
                 const RefinementLimits& limits);

    RefinedBoard refine(const Homography& rough) const;

   private:
    bool judge_plate(RefinedBoard& board) const;
    double scale_of(const Homography& h) const;  ///< px a m across the holes' sides, their mean
    std::vector<SidePoint> measure(const Homography& h, double reach_in_sides, double least_px,
                                   double most_px) const;
    bool fit_board(Homography& h, const std::vector<SidePoint>& points,
                   const std::vector<bool>& use, const std::vector<double>& wall) const;
    /// How far into the hole each side's edge lies, beyond what `wall` explains, m; 0 for those
    /// without points.
    std::vector<double> side_insets(const Homography& h, const std::vector<SidePoint>& points,
                                    const std::vector<double>& wall) const;
    /// The common inset of the measured sides, m.
    double fit_inset(const Homography& h, const std::vector<SidePoint>& points,
                     const std::vector<bool>& use, const std::vector<double>& wall) const;
    std::vector<bool> select_sides(const Homography& h, const std::vector<SidePoint>& points,
                                   double inset, const std::vector<double>& wall) const;

    const EdgeSampler& edges_;
    const HoleLayout& layout_;
    const CameraModel& camera_;
    RefinementLimits limits_;
};

}  // namespace petal
