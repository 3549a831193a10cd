// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <functional>
#include <string>
#include <vector>

#include "solvers/detail/corner_covariance.hpp"
#include "solvers/detail/joint_model.hpp"
#include "solvers/detail/solve_input.hpp"

namespace petal {

/// What is taken for the noise where a detector does not tell.
struct JointNoiseParams {
    bool use_distortion = true;
    double assumed_board_sigma = 0.005;    ///< m, of a LiDAR board's pose at its centre
    double assumed_board_sigma_deg = 0.3;  ///< deg, about it
    double point_sigma = 0.005;            ///< m, of a single LiDAR point, along each axis
    double sigma_px = 1.0;                 ///< what covariance 1 of a pair stands for
    double min_sigma_px = 0.02;            ///< no direction of a board's corners is taken as better
    double board_redundancy =
        kBoardRedundancy;  ///< of corners that come without a covariance of the board
};

/// One LiDAR and the cameras that are solved together, because boards link them.
struct JointInput {
    JointModel model;
    std::vector<SolveInput> cameras;  ///< the pairs of each camera of the model, as they came
};

struct JointInputs {
    std::vector<JointInput> solvable;
    /// Cameras with too few pairs, each with no more than its labels and pairs.
    std::vector<SolveInput> too_few;
};

/// Sorts what was gathered. \throws Error naming scene and board where a covariance is none, or
/// corners are not one a pixel; where a camera's intrinsics differ between scenes.
/// `wanted`, where given, says of which cameras only.
JointInputs joint_inputs(const std::vector<Packet<Correspondences>>& packets,
                         const JointNoiseParams& params,
                         const std::function<bool(const SolveInput&)>& wanted = {});

}  // namespace petal
