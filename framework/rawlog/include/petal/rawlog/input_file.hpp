// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <filesystem>
#include <string>

namespace petal {

/// \throws Error naming `what` and the file: absent, a folder, a pipe, unreadable.
void require_file(const std::filesystem::path& file, const std::string& what);

/// The bytes of a file. \throws Error as require_file, and when reading fails half-way.
std::string read_whole_file(const std::filesystem::path& file, const std::string& what);

}  // namespace petal
