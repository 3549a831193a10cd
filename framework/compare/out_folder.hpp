// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <filesystem>
#include <string>

#include "comparison.hpp"
#include "plan.hpp"

namespace petal::compare {

/// The output folder of a comparison, held by this process alone until it goes.
class OutFolder {
   public:
    /// Makes the folder where it is missing. One that holds the same comparison (by its name) goes
    /// on from there. \throws UsageError: it holds a run, another comparison, or other files; it
    /// lies in the data; another process is at work in it. Error: it cannot be written to.
    OutFolder(const std::filesystem::path& out, const Comparison& comparison, const Plan& plan);
    OutFolder(const OutFolder&) = delete;
    OutFolder& operator=(const OutFolder&) = delete;
    ~OutFolder();

    const std::filesystem::path& path() const { return folder_; }
    /// Whole or not at all. \throws WriteError.
    void write(const std::filesystem::path& name, const std::string& text) const;

   private:
    void check_place(const std::filesystem::path& out, const Plan& plan) const;
    void check_content(const std::filesystem::path& out, const std::string& name) const;
    void lock(const std::filesystem::path& out);

    std::filesystem::path folder_;
    int lock_ = -1;
};

}  // namespace petal::compare
