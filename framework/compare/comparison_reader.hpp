// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "comparison.hpp"
#include "pipeline.hpp"

namespace petal::compare {

/// The format version that this program reads.
constexpr int kComparisonFormat = 1;

/// A comparison, or everything that is wrong with its file: exactly one of the two.
struct CheckedComparison {
    std::optional<Comparison> comparison;
    std::vector<Problem> problems;
};

/// Reads a comparison file. What it says of pipelines is checked with the pipelines: make_plan().
CheckedComparison read_comparison(const std::filesystem::path& file);

/// The same of a text that is in memory already; `file` gives the name and what paths are relative
/// to.
CheckedComparison read_comparison_text(const std::string& text, const std::filesystem::path& file);

/// The JSON schema of comparison files, with the patches of these stages.
std::string comparison_schema(const Registry& registry);

}  // namespace petal::compare
