// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "firing_tape.hpp"
#include "loader.hpp"
#include "plan.hpp"
#include "run_report.hpp"
#include "unit_store.hpp"

namespace petal::compare {

/// What the firings of each stage depend on: its id, type and parameters, the seed, and the same of
/// all that is upstream. Two stages with the same key in two pipelines give the same packets. Sinks
/// have none: each run needs its own products.
std::map<std::string, std::string> sharing_keys(const Pipeline& pipeline);

/// Runs units that have data and seed in common, one after the other on one thread, and executes
/// once what they share: the packets of a stage are kept until the last unit that needs them.
class GroupRunner {
   public:
    /// `work`: where runs write while they are at work. With `share` false every stage fires in
    /// every unit.
    GroupRunner(const Comparison& comparison, const Plan& plan, const PluginSet& plugins,
                std::filesystem::path work, bool share)
        : comparison_(comparison),
          plan_(plan),
          plugins_(plugins),
          work_(std::move(work)),
          share_(share) {}

    /// Gives each unit to `finished`, in order. \throws WriteError where the disk, not the unit,
    /// failed.
    void run(const std::vector<std::size_t>& units,
             const std::function<void(const UnitRecord&)>& finished);

   private:
    struct Prepared {
        const Unit* unit = nullptr;
        Pipeline pipeline;
        std::filesystem::path folder;
        std::map<std::string, std::string> keys;
    };
    Prepared prepare(const Unit& unit) const;
    UnitRecord run_one(const Prepared& prepared);
    UnitRecord record_of(const Prepared& prepared, const RunReport& report) const;

    const Comparison& comparison_;
    const Plan& plan_;
    const PluginSet& plugins_;
    std::filesystem::path work_;
    bool share_;
    FileSums sums_;
    std::map<std::string, std::size_t> wanted_;  ///< by key: units to come that have it
    std::map<std::string, FiringTape> tapes_;
};

}  // namespace petal::compare
