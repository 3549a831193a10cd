// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>
#include <string>

#include "petal/calibration/extrinsics.hpp"

namespace petal {

/// What is left at the pairs, in total, by camera and by scene (named by frame number): count, RMS,
/// and along each axis the five numbers of a box plot (null where there are no pairs).
nlohmann::ordered_json residuals_json(const Extrinsics& extrinsics,
                                      const std::map<std::uint64_t, std::string>& names);

}  // namespace petal
