// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <filesystem>
#include <string>

namespace petal {

/// runs/<pipeline>-<UTC time> below the working folder, with -2, -3 ... where that exists: where a
/// run without
/// --out writes.
std::filesystem::path default_run_folder(const std::string& pipeline);

/// What a run reads, and so must not write into.
struct RunInputs {
    std::filesystem::path data;      ///< --data; may be empty
    std::filesystem::path pipeline;  ///< the pipeline file
};

/// Makes an output folder ready for a run and claims it: absolute, made where missing, with a
/// run.json that says "running", so that no second run takes it and a killed run can be told from a
/// whole one. An existing one that holds a run is refused, or with `force` emptied of what that run
/// wrote. \throws UsageError naming the folder: it holds a run, or files like a run's that are
/// none; it is a file; it lies in the data; it is the pipeline's folder or the working folder.
/// Error: it cannot be written to.
std::filesystem::path prepare_run_folder(const std::filesystem::path& out, bool force,
                                         const RunInputs& inputs);

/// Adds a product to the run.json of a run that goes on, so that a later run with --force knows it
/// although this one is killed. Does nothing where run.json does not say "running".
/// \throws Error when it cannot be written.
void note_product(const std::filesystem::path& folder, const std::filesystem::path& product);

/// Changes the run.json of a run that goes on where the whole one cannot be written: the status is
/// `status`, and `error`, if there is room for it, the only error. Does nothing where run.json does
/// not say "running". Never throws.
void note_end(const std::filesystem::path& folder, const std::string& status,
              const std::string& error) noexcept;

/// Removes the temporary files of a run's products and of its stages' files. Never throws.
void remove_temporaries(const std::filesystem::path& folder) noexcept;

}  // namespace petal
