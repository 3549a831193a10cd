// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <filesystem>
#include <vector>

#include "loader.hpp"

namespace petal {

/// A file that may be a plugin.
struct Candidate {
    std::filesystem::path library;  ///< canonical
    std::size_t folder = 0;         ///< index of the folder that it was found in
};

/// The files `*.so` of the folders, sorted by file name in each, each library once. A folder that
/// does not exist holds none; a folder that cannot be read and a link that leads nowhere become
/// refusals.
std::vector<Candidate> find_candidates(const std::vector<std::filesystem::path>& folders,
                                       std::vector<Refusal>& refused);

}  // namespace petal
