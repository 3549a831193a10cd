// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "unit_runs.hpp"

#include <chrono>
#include <csignal>
#include <deque>
#include <iostream>
#include <set>
#include <system_error>
#include <utility>

#include "child_pool.hpp"
#include "firing_clock.hpp"
#include "petal/error.hpp"
#include "run_progress.hpp"

namespace petal::compare {

namespace fs = std::filesystem;

namespace {

/// Exit code of a child that could not go on, e.g. for want of space: no unit's fault.
constexpr int kCannotGoOn = 74;   // EX_IOERR
constexpr double kWaitFor = 0.2;  // s

class UnitRunner {
   public:
    UnitRunner(const Comparison& comparison, const Plan& plan, const PluginSet& plugins,
               FileSums& sums, const UnitRunSettings& settings)
        : comparison_(comparison),
          plan_(plan),
          plugins_(plugins),
          sums_(sums),
          settings_(settings),
          store_(settings.out / "units"),
          start_(std::chrono::steady_clock::now()) {}

    UnitRuns run() {
        remove_leftovers();
        std::deque<std::size_t> waiting;
        for (std::size_t g = 0; g < plan_.groups.size(); ++g) {
            load_finished(g);
            const std::size_t missing = pending(g).size();
            progress_.of += missing;
            if (missing > 0) waiting.push_back(g);
        }
        runs_.reused = runs_.records.size();
        if (settings_.check) settings_.check(runs_.records);
        ChildPool pool([this](std::size_t group) { return work(group); });
        while (!waiting.empty() || pool.running() > 0) {
            if (cancelled()) break;
            while (!waiting.empty() && pool.running() < static_cast<std::size_t>(settings_.jobs)) {
                pool.start(waiting.front());
                waiting.pop_front();
            }
            const auto ended = pool.wait(kWaitFor);
            if (ended && settle(*ended)) waiting.push_front(ended->job);
            tell_progress();
        }
        return std::move(runs_);
    }

   private:
    bool cancelled() {
        runs_.cancelled = settings_.cancel != nullptr && settings_.cancel->load();
        return runs_.cancelled;
    }

    void remove_leftovers() const {
        std::error_code ignored;
        fs::remove_all(settings_.out / "work", ignored);
        store_.remove_leftovers();
    }

    std::vector<std::size_t> pending(std::size_t group) const {
        std::vector<std::size_t> units;
        for (const std::size_t unit : plan_.groups[group].units)
            if (runs_.records.count(plan_.units[unit].key) == 0) units.push_back(unit);
        return units;
    }

    /// Units of an earlier start.
    void load_finished(std::size_t group) {
        for (const std::size_t unit : plan_.groups[group].units) {
            const std::string& key = plan_.units[unit].key;
            std::string damage;
            auto record = store_.load(key, damage);
            if (!damage.empty()) settings_.tell("damaged, so it is run again: " + damage);
            if (!record) continue;
            const std::string changed = UnitStore::changed_file(*record, sums_);
            if (changed.empty()) {
                runs_.records.emplace(key, std::move(*record));
            } else {
                settings_.tell("unit " + key + " is run again: " + changed + " has changed");
            }
        }
    }

    /// In the child.
    int work(std::size_t group) const {
        try {
            GroupRunner runner(comparison_, plan_, plugins_, settings_.out / "work",
                               settings_.share);
            runner.run(pending(group), [this](const UnitRecord& record) { store_.store(record); });
            return 0;
        } catch (const std::exception& failure) {
            std::cerr << "petal: " << failure.what() << "\n";
            return kCannotGoOn;
        }
    }

    /// Takes in what a child left. True where its group is to go on.
    bool settle(const ChildEnd& ended) {
        const auto units = pending(ended.job);
        for (const std::size_t unit : units) {
            const std::string& key = plan_.units[unit].key;
            std::string damage;
            auto record = store_.load(key, damage);
            if (!record) break;
            take(std::move(*record));
        }
        const auto left = pending(ended.job);
        if (left.empty()) {
            if (settings_.check) settings_.check(runs_.records);
            return false;
        }
        if (ended.signal == 0 && ended.exit_code == kCannotGoOn)
            throw Error(
                "stopped, for the reason above; what is finished stays, and the same "
                "command goes on from there");
        const Unit& culprit = plan_.units[left.front()];
        // Killed from outside, or for want of memory: it may have been its neighbour's fault.
        if (ended.signal == SIGKILL && killed_.insert(culprit.key).second) return true;
        take(crash_record(culprit, ended));
        if (left.size() > 1) return true;
        if (settings_.check) settings_.check(runs_.records);
        return false;
    }

    UnitRecord crash_record(const Unit& unit, const ChildEnd& ended) const {
        UnitRecord record;
        record.key = unit.key;
        record.variant = comparison_.variants[unit.variant].name;
        record.data = comparison_.data[unit.data].name;
        record.seed = unit.seed;
        record.status = "crash";
        record.reasons = {to_string(ended)};
        if (ended.signal == SIGKILL) record.reasons.front() += ", twice; out of memory?";
        store_.store(record);
        return record;
    }

    void take(UnitRecord record) {
        ++progress_.done;
        if (record.status != "done") {
            ++progress_.failed;
            settings_.tell("failed: " + record.variant + ", " + record.data + ", seed " +
                           std::to_string(record.seed) + ": " + record.status +
                           (record.reasons.empty() ? "" : ": " + record.reasons.front()));
        }
        runs_.records.emplace(record.key, std::move(record));
    }

    void tell_progress() {
        if (!settings_.on_progress) return;
        progress_.elapsed_s = seconds_since(start_);
        settings_.on_progress(progress_);
    }

    const Comparison& comparison_;
    const Plan& plan_;
    const PluginSet& plugins_;
    FileSums& sums_;
    const UnitRunSettings& settings_;
    UnitStore store_;
    UnitRuns runs_;
    UnitProgress progress_;
    std::set<std::string> killed_;
    std::chrono::steady_clock::time_point start_;
};

}  // namespace

std::string to_string(const UnitProgress& progress) {
    std::string text =
        "units " + std::to_string(progress.done) + " of " + std::to_string(progress.of);
    if (progress.failed > 0) text += ", " + std::to_string(progress.failed) + " failed";
    if (progress.done > 0 && progress.done < progress.of) {
        const double each = progress.elapsed_s / static_cast<double>(progress.done);
        text += ", about " +
                duration_text(each * static_cast<double>(progress.of - progress.done)) + " left";
    }
    return text;
}

UnitRuns run_units(const Comparison& comparison, const Plan& plan, const PluginSet& plugins,
                   FileSums& sums, const UnitRunSettings& settings) {
    UnitRunner runner(comparison, plan, plugins, sums, settings);
    UnitRuns runs = runner.run();
    std::error_code ignored;
    fs::remove_all(settings.out / "work", ignored);
    return runs;
}

}  // namespace petal::compare
