// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <functional>
#include <string>
#include <vector>

#include "firing.hpp"

namespace petal {

/// All that a stage did in a run, firing by firing: a later run that has the same stage (id, type,
/// parameters, seed) behind the same upstream plays it instead of firing the stage again.
struct FiringTape {
    struct Entry {
        OutputPackets outputs;
        bool source_ended = false;
        std::vector<std::function<void(RunServices&)>> told;  ///< notes, verdicts, files, log
    };
    std::vector<Entry> firings;
    bool whole = false;        ///< the stage came to its end
    bool wrote_files = false;  ///< they lie in that run's folder: another run must fire it itself

    bool can_be_played() const { return whole && !wrote_files; }
};

/// Takes down what one firing tells, and passes it on.
class TapingServices final : public RunServices {
   public:
    TapingServices(RunServices& real, FiringTape& tape) : real_(real), tape_(tape) {}

    void log(const std::string& stage, LogLevel level, const std::string& message) override;
    void note(const std::string& stage, const FrameInfo& frame, const Note& note) override;
    void verdict(const std::string& stage, Level level,
                 const std::vector<std::string>& reasons) override;
    void progress(const std::string& stage, double done, double total,
                  std::string_view unit) override;
    void used_file(const std::filesystem::path& path) override;
    void claim_product(const std::string& stage, const std::filesystem::path& name) override;
    bool debug(const std::string& stage) const override { return real_.debug(stage); }
    bool cancelled() const override { return real_.cancelled(); }
    int threads() const override { return real_.threads(); }
    std::uint64_t seed() const override { return real_.seed(); }
    /// Asked for by what writes files only.
    const std::filesystem::path& folder() const override;

    /// The firing is over and was no failure.
    void add_entry(const OutputPackets& outputs, bool source_ended);

   private:
    RunServices& real_;
    FiringTape& tape_;
    std::vector<std::function<void(RunServices&)>> told_;
};

}  // namespace petal
