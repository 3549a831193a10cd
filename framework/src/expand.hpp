// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <optional>
#include <string>

namespace petal {

/// What `${data}` and `${out}` stand for; where absent they stay as they are.
struct Expansions {
    std::optional<std::string> data;
    std::optional<std::string> out;
};

struct Expanded {
    std::string text;
    std::string fault;       ///< empty, or what is wrong with it and what was expected
    bool asks_data = false;  ///< `${data}` is used and unknown
};

/// Replaces `${data}`, `${out}` and `${env:NAME}`, each once: what they bring is not expanded
/// again.
Expanded expand(const std::string& text, const Expansions& expansions);

}  // namespace petal
