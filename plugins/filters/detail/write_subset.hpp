// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "petal/calibration/cloud_subset.hpp"
#include "petal/run.hpp"

namespace petal {

/// What every remover of outliers tells and writes: the points with `indices` (ascending) go out on
/// `cloud`; how many stay is logged. Notes tell of an empty cloud, of points that were dropped as
/// they are not finite, and, with the text of `none_stays`, where no point stays of `finite` ones.
void write_subset(Run& run, const Cloud& cloud, const std::vector<std::uint32_t>& indices,
                  std::size_t finite, const Note& none_stays);

}  // namespace petal
