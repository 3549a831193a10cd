// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>

namespace petal {

/// A pipeline or patch that is larger is none.
constexpr std::size_t kLargestPipelineFile = std::size_t{4} << 20U;

/// The file's text; or nothing, and in `why` what is wrong with the file and what was expected.
std::optional<std::string> read_text_file(const std::filesystem::path& file, std::string& why);

}  // namespace petal
