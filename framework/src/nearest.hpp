// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <string>
#include <vector>

namespace petal {

/// The name of `known` that a typo most likely meant: smallest Damerau-Levenshtein distance, at
/// most a third of the length and at least 1 allowed. Empty when none is near.
std::string nearest(const std::string& typo, const std::vector<std::string>& known);

/// "; did you mean 'radius'?" or nothing.
std::string did_you_mean(const std::string& typo, const std::vector<std::string>& known);

/// "a, b, c", for "expected one of ...".
std::string join(const std::vector<std::string>& words, const std::string& separator = ", ");

}  // namespace petal
