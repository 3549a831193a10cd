// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "plan.hpp"

namespace petal::compare {

/// A finished unit as it is stored.
struct UnitRecord {
    std::string key;
    std::string variant;  ///< the first that had this key
    std::string data;
    std::uint64_t seed = 0;
    std::string status;                ///< done, error, crash
    std::string verdict;               ///< usable, weak, not_usable; empty where none was told
    std::vector<std::string> reasons;  ///< of the verdict, or what went wrong
    std::map<std::string, std::string> files;  ///< used files and their checksums
    std::vector<std::string> executed;         ///< ids of the stages that fired
    std::vector<std::string> shared;           ///< and of those whose packets another unit left
    double wall_s = 0.0;
    double cpu_s = 0.0;
    std::uint64_t peak_memory_bytes = 0;
    std::map<std::string, double> stage_wall_s;  ///< of those that fired
    std::string result;                          ///< text of result.json; empty where there is none
    /// What stages drew in a unit that failed, by name. Stored, and not loaded with the record.
    std::map<std::string, std::string> pictures = {};
};

/// Finished units in a folder: OUT/units/<key>/unit.json, result.json and pictures/. A unit is
/// there whole or not at all: it is written beside and renamed.
class UnitStore {
   public:
    explicit UnitStore(std::filesystem::path folder) : folder_(std::move(folder)) {}

    const std::filesystem::path& folder() const { return folder_; }
    bool holds(const std::string& key) const;
    /// Nothing where there is none, or not a whole one; then `damage` says what is wrong with it.
    std::optional<UnitRecord> load(const std::string& key, std::string& damage) const;
    /// The files of what stages drew in that unit, by name.
    std::vector<std::filesystem::path> pictures(const std::string& key) const;
    /// A used file that is another one now, or gone; empty where all are as they were.
    static std::string changed_file(const UnitRecord& record, FileSums& sums);
    /// Replaces what lies there. \throws WriteError.
    void store(const UnitRecord& record) const;
    void remove(const std::string& key) const;
    /// What processes that were killed left half-way.
    void remove_leftovers() const;

   private:
    std::filesystem::path place(const std::string& key) const { return folder_ / key; }

    std::filesystem::path folder_;
};

}  // namespace petal::compare
