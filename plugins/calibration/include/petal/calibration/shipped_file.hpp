// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace petal {

/// The file that `name_or_path` means: one that petal ships, or any other. A bare name
/// ("four_square_holes_500mm") means the shipped <prefix>/share/petal/<folder>/<name>.json,
/// whatever lies in the working folder. `what` is told in messages: "target". \throws Error when
/// there is none: the shipped names are listed.
std::filesystem::path find_shipped_file(const std::string& folder, const std::string& what,
                                        const std::filesystem::path& name_or_path);

/// The names in <prefix>/share/petal/<folder>, in alphabetical order.
std::vector<std::string> shipped_names(const std::string& folder);

}  // namespace petal
