// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <filesystem>
#include <string>

namespace petal {

/// runs/<pipeline>-<UTC time>, below the working folder: where a run without --out writes.
std::filesystem::path default_run_folder(const std::string& pipeline);

/// Makes an output folder ready for a run: absolute, made where missing, writable.
/// An existing one that holds a run is refused, or with `force` emptied of that run's files.
/// \throws Error naming the folder: it holds a run; it cannot be written to; it is a file; it is
/// `data`.
std::filesystem::path prepare_run_folder(const std::filesystem::path& out, bool force,
                                         const std::filesystem::path& data);

}  // namespace petal
