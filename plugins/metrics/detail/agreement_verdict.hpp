// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <string>
#include <vector>

#include "metrics/agreement.hpp"
#include "metrics/detail/pose_agreement.hpp"
#include "petal/calibration/extrinsics.hpp"

namespace petal {

/// The level that the result to hold was given by its own run; what it lacked is added to the
/// reasons. No agreement makes it better.
Level judge_known(const Extrinsics& known, std::vector<std::string>& reasons);

/// The level of one camera whose corners miss by `px` (RMS); the reasons (why not better) are
/// added.
Level judge_agreement(const CameraExtrinsics& camera, double px, const DriftSum::Result& drift,
                      const AgreementParams& params, std::vector<std::string>& reasons);

}  // namespace petal
