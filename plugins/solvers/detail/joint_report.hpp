// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <optional>
#include <string>
#include <vector>

#include "petal/calibration/extrinsics.hpp"
#include "solvers/detail/joint_params.hpp"
#include "solvers/detail/joint_search.hpp"

namespace petal {

/// Solves one group of cameras and judges the result. Returns the level; the cameras and the
/// reasons why not better are added to `extrinsics`. None where no pose was found.
std::optional<Level> report_joint(const JointInput& input, const JointParams& params,
                                  const std::optional<TranslationPrior>& prior,
                                  Extrinsics& extrinsics);

}  // namespace petal
