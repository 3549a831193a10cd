// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "sources/detail/scene_name.hpp"

#include <system_error>

namespace petal {

std::string scene_name(const std::filesystem::path& file) {
    std::error_code ignored;
    const std::filesystem::path absolute = std::filesystem::weakly_canonical(file, ignored);
    const std::string name = absolute.parent_path().filename().string();
    return name.empty() ? file.stem().string() : name;
}

}  // namespace petal
