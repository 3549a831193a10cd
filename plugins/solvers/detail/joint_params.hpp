// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <string>
#include <vector>

#include "solvers/detail/joint_input.hpp"
#include "solvers/detail/joint_uncertainty.hpp"
#include "solvers/detail/verdict.hpp"

namespace petal {

/// Parameters of `solver.joint`.
struct JointParams : JointNoiseParams, ConsiderParams, VerdictParams {
    JointParams() {}  // not an aggregate: GCC 12 warns of one with such bases
    std::string robust_loss = "huber";

    /// The weights allow for an offset this many times its sigma: so one sigma of it hardly moves
    /// the pose.
    double range_offset_allowance = 2.0;
    bool estimate_focal = false;
    double usable_tilt_deg = 5.0;           ///< RMS, between the boards, about any axis
    double max_focal_sigma = 0.003;         ///< of 1
    std::vector<double> prior_translation;  ///< m; empty: none
    double prior_sigma = 0.1;               ///< m
    std::string prior_camera;               ///< empty: the only one
    double advice_min_range = 2.0, advice_max_range = 6.0;  ///< m
};

}  // namespace petal
