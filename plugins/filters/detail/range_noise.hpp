// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <optional>

#include "filters/detail/angular_cells.hpp"
#include "petal/run.hpp"

namespace petal {

/// The noise of ranges (1 sigma, m), from how far points lie off local planes: a plane is fitted to
/// the points of 3 x 3 cells, at up to 4096 places spread over the cloud, and the median over
/// places is taken, which edges do not reach as long as most places are smooth. Places from 1 to
/// 12 m off count, where boards stand; all places where fewer than 30 do lie there. None where no
/// place has points enough (12).
std::optional<double> range_noise(const AngularCells& cells, const Run& run);

}  // namespace petal
