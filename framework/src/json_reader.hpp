// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

#include "json_tree.hpp"

namespace petal {

/// Lists and objects inside one another, at most.
constexpr std::size_t kDeepestJson = 64;

/// Reads one JSON text (`//` comments allowed) into a tree that keeps lines and the way numbers
/// were written. Problems: duplicate keys (the last one stays), numbers that fit no 64-bit type
/// (they become `invalid`); and, with nothing returned, syntax errors and values nested too deep.
/// `path` is where the text belongs, for problems in it; `file` is its number in `problems`.
std::optional<JsonNode> read_json(std::string_view text, std::size_t file, const std::string& path,
                                  ProblemList& problems);

}  // namespace petal
