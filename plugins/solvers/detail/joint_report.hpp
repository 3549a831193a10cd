// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "petal/calibration/extrinsics.hpp"
#include "solvers/detail/joint_params.hpp"
#include "solvers/detail/joint_search.hpp"

namespace petal {

/// Solves one group of cameras and judges the result. Returns the level; the cameras and the
/// reasons why not better are added to `extrinsics`. None where no pose was found: then nothing is.
/// `poll` is called now and then and may throw, to cancel.
std::optional<Level> report_joint(const JointInput& input, const JointParams& params,
                                  const std::optional<TranslationPrior>& prior,
                                  const std::function<void()>& poll, Extrinsics& extrinsics);

}  // namespace petal
