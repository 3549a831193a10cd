// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "draft.hpp"

namespace petal {

/// The pipeline with every default written out, patches applied: a pipeline file that gives the
/// same run with the same data and environment (`${...}` stays as written, so that no path of this
/// machine enters). Stages in `order`; ports and parameters as declared. Ends with a line break.
std::string effective_json(const std::string& about, std::uint64_t seed, const Draft& draft,
                           const std::vector<std::size_t>& order);

}  // namespace petal
