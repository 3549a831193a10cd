// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <functional>
#include <vector>

#include "detectors/detail/image_layout.hpp"
#include "detectors/detail/image_template_model.hpp"
#include "detectors/detail/image_template_regions.hpp"
#include "petal/calibration/camera_model.hpp"

namespace petal {

/// Where a board may be, by the regions that lie as its holes do, or by one that has its outline.
struct TemplateGuess {
    std::vector<Eigen::Vector2d> board;       ///< m, four points or more
    std::vector<Eigen::Vector2d> image;       ///< ideal pixels of the same points
    Homography map = Homography::Identity();  ///< affine, from the board to ideal pixels
    int holes_seen = 0;                       ///< 0: a plate
    double misfit =
        0.0;  ///< RMS of the regions' middles about their affine map, over a hole's size
};

struct GuessSearch {
    std::vector<TemplateGuess> guesses;  ///< the likeliest first
    int best_holes = 0;                  ///< of any group, also those with too few
};

/// The guess of an affine map.
TemplateGuess guess_at(const Homography& map, const TemplateModel& model, int holes_seen);

/// Groups regions by the model's geometry: the moments of one region and the direction to a second
/// give an affine map, which says where the other holes are; regions found there join, all of them
/// and those alone that look whole. And single regions: of the outline's moments (plates), and
/// where `min_holes` is 1 of a hole's, turned until the polygon fits.
GuessSearch guess_boards(const RegionSearch& regions, const TemplateModel& model,
                         const CameraModel& camera, int min_holes,
                         const std::function<void()>& check);

/// The poses (T_camera_board) that a guess allows: a plane seen with little perspective has two.
std::vector<Eigen::Isometry3d> guess_poses(const TemplateGuess& guess, const CameraModel& camera);

}  // namespace petal
