// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <map>
#include <mutex>
#include <set>
#include <string>
#include <vector>

#include "firing.hpp"
#include "run_log.hpp"
#include "run_progress.hpp"
#include "run_report.hpp"
#include "runner.hpp"

namespace petal {

/// Takes down what the stages of a run tell, from any thread, and sorts it so that the order does
/// not depend on the threads.
class RunRecorder final : public RunServices {
   public:
    RunRecorder(const RunSettings& settings, std::uint64_t seed, RunLog& log)
        : settings_(settings), seed_(seed), log_(log) {}

    void log(const std::string& stage, LogLevel level, const std::string& message) override;
    void note(const std::string& stage, const FrameInfo& frame, const Note& note) override;
    void verdict(const std::string& stage, Level level,
                 const std::vector<std::string>& reasons) override;
    void progress(const std::string& stage, double done, double total,
                  std::string_view unit) override;
    void used_file(const std::filesystem::path& path) override;
    void claim_product(const std::string& stage, const std::filesystem::path& name) override;
    bool debug(const std::string& stage) const override;
    bool cancelled() const override;
    int threads() const override { return settings_.threads; }
    std::uint64_t seed() const override { return seed_; }
    const std::filesystem::path& folder() const override { return settings_.folder; }

    /// What the stage told last.
    SourceProgress progress_of(const std::string& stage) const;

    /// Moves all that was told into the report. Call it when no stage fires any more.
    void fill(RunReport& report, const Pipeline& pipeline);

   private:
    const RunSettings& settings_;
    std::uint64_t seed_;
    RunLog& log_;
    mutable std::mutex mutex_;
    std::map<std::string, SourceProgress> progress_;
    std::vector<ToldNote> notes_;
    std::vector<ToldVerdict> verdicts_;
    std::map<std::filesystem::path, std::string> products_;  ///< whose each is
    std::set<std::filesystem::path> used_paths_;
};

}  // namespace petal
