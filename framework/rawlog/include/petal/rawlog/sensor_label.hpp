// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <string>
#include <vector>

namespace petal {

/// Whether a label is that one, or fits it as a shell pattern (`*`, `?`, `[...]`).
bool label_fits(const std::string& pattern, const std::string& label);

/// Whether it fits one of them.
bool label_fits_any(const std::vector<std::string>& patterns, const std::string& label);

}  // namespace petal
