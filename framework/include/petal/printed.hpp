// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <string>

namespace petal {

/// printf's text, with a decimal point whatever the locale of the process: what a stage tells
/// reaches result.json, whose bytes must not depend on it.
[[gnu::format(printf, 1, 2)]] std::string printed(const char* pattern, ...);

}  // namespace petal
