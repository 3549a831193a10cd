// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <filesystem>
#include <string>

namespace petal {

/// What the scene of a file is called: its folder, or its stem where the folder has no name.
std::string scene_name(const std::filesystem::path& file);

}  // namespace petal
