// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace petal::compare {

/// A run has at most so many seeds.
constexpr std::size_t kMostSeeds = 100000;

/// Reads "1..20", "3", "1..5,8,10..12". Empty, and in `why` what is wrong and what was expected,
/// where it is none, a seed comes twice, or there are more than kMostSeeds.
std::vector<std::uint64_t> read_seeds(const std::string& text, std::string& why);

}  // namespace petal::compare
