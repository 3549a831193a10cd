// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <optional>
#include <string>
#include <vector>

#include "comparison.hpp"

namespace petal::compare {

/// What the command line changes of a comparison.
struct Selection {
    std::vector<std::string> only;     ///< names of variants and data; the reference stays
    std::vector<std::string> folders;  ///< data folders in place of the file's data
    std::string seeds;                 ///< for all data
    std::vector<std::string> metrics;  ///< NAME, NAME:lower, NAME:higher:MARGIN
    std::vector<PipelineChange> last;  ///< after all changes of the file
};

/// \throws UsageError naming what is wrong, and the nearest right name.
void apply(const Selection& selection, Comparison& comparison);

/// The quick form: whole pipelines against the first of them.
/// \throws UsageError where two have one name.
Comparison quick_comparison(const std::vector<std::filesystem::path>& pipelines);

}  // namespace petal::compare
