// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <cstdint>
#include <string>
#include <variant>
#include <vector>

namespace petal {

/// The kinds a parameter can have. A list of any of them is a kind with ParamSpec::list set.
enum class Kind { boolean, integer, real, text, choice, path };

/// "bool", "int", "double", "string", "choice", "path": the words of the documentation.
const char* to_string(Kind kind);

/// A parameter's value, free of any JSON library. `choice` and `path` are strings here.
using Value =
    std::variant<bool, std::int64_t, double, std::string, std::vector<bool>,
                 std::vector<std::int64_t>, std::vector<double>, std::vector<std::string>>;

}  // namespace petal
