// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "checksums.hpp"
#include "comparison.hpp"
#include "loader.hpp"

namespace petal::compare {

/// Checksums of files, each computed once.
class FileSums {
   public:
    /// \throws Error where the file cannot be read.
    const std::string& of(const std::filesystem::path& file);
    /// The same; empty where it cannot be read.
    std::string of_any(const std::filesystem::path& file);

   private:
    std::map<std::filesystem::path, std::string> sums_;
};

/// A checked pipeline of one variant on one data item, for any seed.
struct PlannedPipeline {
    /// All defaults written out, as a pipeline file: later changes of files change nothing.
    std::string text;
    std::string name;                             ///< the pipeline file, for messages
    std::string build;                            ///< plugins' versions, checksums of the libraries
    std::map<std::string, std::string> versions;  ///< of its plugins
};

struct PlannedData {
    std::filesystem::path folder;  ///< absolute; empty: none
    std::string sums;              ///< of all files in it, by name
};

struct Unit {
    std::size_t variant = 0;
    std::size_t data = 0;
    std::uint64_t seed = 0;
    std::string key;  ///< the same for variants whose effective pipelines are the same
};

/// Units on the same data with the same seed: stages that they share are executed once.
struct Group {
    std::size_t data = 0;
    std::uint64_t seed = 0;
    std::vector<std::size_t> units;  ///< numbers of Plan::units; each key in one group
};

struct Plan {
    std::vector<std::vector<PlannedPipeline>> pipelines;  ///< by variant and data
    std::vector<PlannedData> data;
    std::vector<Unit> units;
    std::vector<Group> groups;  ///< the first seed of every data item comes first
    bool missing_type = false;  ///< among the problems: perhaps a refused library has it
    std::vector<Problem> problems;
};

/// Checks every pipeline of the comparison and names its units. Nothing but `problems` counts where
/// there are any.
Plan make_plan(const Comparison& comparison, const PluginSet& plugins, FileSums& sums);

}  // namespace petal::compare
