// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "json_tree.hpp"

namespace petal {

/// Turns `STAGE.PARAM=JSON` of the command line into a patch. Nothing, and a problem, where it is
/// none: a bare word is not taken for a string. `file` is its number in `problems`.
std::optional<JsonNode> read_set_option(const std::string& option, std::size_t file,
                                        ProblemList& problems);

}  // namespace petal
