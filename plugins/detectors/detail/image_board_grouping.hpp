// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <cstddef>
#include <vector>

#include "detectors/detail/image_layout.hpp"
#include "detectors/detail/image_squares.hpp"
#include "petal/calibration/camera_model.hpp"

namespace petal {

/// Squares that lie as the target's holes do.
struct BoardHypothesis {
    Homography board_to_image = Homography::Identity();  ///< m to ideal pixels
    std::vector<int> squares;  ///< for each hole the index of its square, -1 where none was seen
    int holes_seen = 0;
    double misfit =
        0.0;  ///< RMS of the squares' corners about the homography, over the hole's side
};

struct Grouping {
    std::vector<BoardHypothesis>
        hypotheses;      ///< the best first: more holes, then the smaller misfit
    int best_holes = 0;  ///< of any group, also those with too few holes
};

/// Groups squares by their mutual geometry, not by a given number of boards: each square in turn is
/// taken for each hole, in each of its four turns, its affine map predicts the other holes, and
/// squares found there join. Works in ideal pixels, where the board's lines are straight.
Grouping group_squares(const std::vector<SquareCandidate>& squares, const HoleLayout& layout,
                       const CameraModel& camera, int min_holes);

}  // namespace petal
