// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "petal/calibration/diagnosis.hpp"
#include "solvers/detail/joint_uncertainty.hpp"

namespace petal {

/// The factor on a camera's focal length that fits best. One step from the solution tells whether
/// the boards show it at all (1 sigma below 2 %); then the problem is solved with it free, since
/// what is far off needs more than a step. `uncertainty` is that of `solution`.
Diagnosis::FocalScale best_focal(const JointModel& model, const JointOptions& options,
                                 const JointSolution& solution, const JointUncertainty& uncertainty,
                                 std::size_t camera);

/// Words for a focal length that is surely another one: more than 3 sigma off, and more than twice
/// as far as the given one is known (`given_sigma`, of 1).
std::optional<std::string> focal_doubt(const Diagnosis::FocalScale& focal, double given_sigma);

}  // namespace petal
