// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <nlohmann/json.hpp>

#include "petal/calibration/extrinsics.hpp"

namespace petal {

/// Adds what a solver knows of the trust in one camera's extrinsics to their entry: chi2 and
/// degrees_of_freedom always, the rest where the solver looked into its result.
void add_diagnosis(nlohmann::ordered_json& entry, const CameraExtrinsics& camera);

}  // namespace petal
