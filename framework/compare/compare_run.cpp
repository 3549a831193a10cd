// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "compare_run.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <set>
#include <system_error>
#include <utility>

#include "figures.hpp"
#include "firing_clock.hpp"
#include "host_errors.hpp"
#include "report.hpp"
#include "text_file.hpp"
#include "unit_outcomes.hpp"

namespace petal::compare {

namespace fs = std::filesystem;

namespace {

double load_average() {
    std::array<double, 1> load{};
    return ::getloadavg(load.data(), 1) == 1 ? load[0] : -1.0;
}

/// Units of the first seeds of each data item, each a group of its own: variants in turn, so that a
/// machine that grows slower does so for all.
Plan timing_plan(const Plan& plan, std::size_t seeds) {
    Plan timing = plan;
    timing.groups.clear();
    timing.units.clear();
    std::map<std::size_t, std::size_t> used;
    for (const Group& group : plan.groups) {
        if (++used[group.data] > seeds) continue;
        for (const std::size_t unit : group.units) {
            timing.groups.push_back({group.data, group.seed, {timing.units.size()}});
            timing.units.push_back(plan.units[unit]);
        }
    }
    // Variants that are alike have the same times.
    for (const Unit& unit : plan.units) {
        const auto same = [&](const Unit& one) { return one.key == unit.key; };
        const auto is_it = [&](const Unit& one) {
            return same(one) && one.variant == unit.variant;
        };
        if (std::any_of(timing.units.begin(), timing.units.end(), same) &&
            std::none_of(timing.units.begin(), timing.units.end(), is_it))
            timing.units.push_back(unit);
    }
    return timing;
}

class ComparisonRun {
   public:
    ComparisonRun(const Comparison& comparison, const Plan& plan, const PluginSet& plugins,
                  FileSums& sums, const OutFolder& out, const CompareSettings& settings)
        : comparison_(comparison),
          plan_(plan),
          plugins_(plugins),
          sums_(sums),
          out_(out),
          settings_(settings) {}

    CompareEnd run() {
        out_.write("run.json",
                   nlohmann::ordered_json{
                       {"petal_compare", 1}, {"name", comparison_.name}, {"status", "running"}}
                           .dump(2) +
                       "\n");
        UnitRuns runs = run_all();
        CompareEnd end;
        end.cancelled = runs.cancelled;
        if (!end.cancelled) end = write_figures(runs);
        if (!end.cancelled && settings_.timing_seeds > 0) end.cancelled = !run_timing();
        out_.write("run.json",
                   run_json(comparison_, plan_, runs, end.cancelled ? "cancelled" : "done",
                            seconds_since(start_)));
        return end;
    }

   private:
    UnitRunSettings unit_settings(const fs::path& folder, const std::string& what) const {
        UnitRunSettings settings;
        settings.out = folder;
        settings.cancel = settings_.cancel;
        settings.tell = settings_.tell;
        if (settings_.on_progress)
            settings.on_progress = [this, what](const UnitProgress& progress) {
                settings_.on_progress(progress, what);
            };
        return settings;
    }

    UnitRuns run_all() const {
        UnitRunSettings settings = unit_settings(out_.path(), "");
        settings.jobs = settings_.jobs;
        settings.share = settings_.share;
        settings.check = [this](const std::map<std::string, UnitRecord>& records) {
            metrics_known_ =
                metrics_known_ || check_metric_names(comparison_, plan_, records, false);
        };
        return run_units(comparison_, plan_, plugins_, sums_, settings);
    }

    CompareEnd write_figures(const UnitRuns& runs) const {
        check_metric_names(comparison_, plan_, runs.records, true);
        const auto outcomes = make_outcomes(comparison_, plan_, runs.records);
        const Figures figures = make_figures(comparison_, outcomes);
        write_csv(figures, outcomes);
        const std::string document = compare_json(comparison_, plan_, figures, outcomes);
        out_.write("compare.json", document);
        out_.write("report.html", report_html(comparison_, figures, outcomes, document,
                                              pictures_of_failed(outcomes)));
        CompareEnd end;
        end.table = table_text(comparison_, figures);
        end.all_failed = std::all_of(outcomes.begin(), outcomes.end(),
                                     [](const UnitOutcome& one) { return !one.failure.empty(); });
        return end;
    }

    UnitPictures pictures_of_failed(const std::vector<UnitOutcome>& outcomes) const {
        UnitPictures pictures;
        const UnitStore store(out_.path() / "units");
        for (const UnitOutcome& outcome : outcomes) {
            if (outcome.failure.empty() || outcome.key.empty()) continue;
            for (const fs::path& file : store.pictures(outcome.key)) {
                std::string why;
                if (const auto bytes = read_text_file(file, why))
                    pictures[outcome.key].push_back(
                        {fs::relative(file, out_.path()).string(), {bytes->begin(), bytes->end()}});
            }
        }
        return pictures;
    }

    void write_csv(const Figures& figures, const std::vector<UnitOutcome>& outcomes) const {
        std::set<fs::path> names;
        for (const MetricFigures& metric : figures.metrics) {
            const fs::path name = csv_name(metric.metric);
            names.insert(name);
            out_.write(fs::path("metrics") / name,
                       metric_csv(comparison_, metric.metric, outcomes));
        }
        std::vector<fs::path> old;  // of metrics that the comparison no longer has
        std::error_code ignored;
        for (const auto& entry : fs::directory_iterator(out_.path() / "metrics", ignored))
            if (names.count(entry.path().filename()) == 0) old.push_back(entry.path());
        for (const fs::path& file : old) fs::remove(file, ignored);
    }

    bool run_timing() const {
        const Plan timing = timing_plan(plan_, settings_.timing_seeds);
        UnitRunSettings settings = unit_settings(out_.path() / "timing", "timing, ");
        settings.share = false;
        const double before = load_average();
        const UnitRuns runs = run_units(comparison_, timing, plugins_, sums_, settings);
        if (runs.cancelled) return false;
        out_.write("timing.json",
                   timing_json(comparison_, timing, runs.records, before, load_average()));
        return true;
    }

    const Comparison& comparison_;
    const Plan& plan_;
    const PluginSet& plugins_;
    FileSums& sums_;
    const OutFolder& out_;
    const CompareSettings& settings_;
    mutable bool metrics_known_ = false;
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

}  // namespace

CompareEnd run_comparison(const Comparison& comparison, const Plan& plan, const PluginSet& plugins,
                          FileSums& sums, const OutFolder& out, const CompareSettings& settings) {
    return ComparisonRun(comparison, plan, plugins, sums, out, settings).run();
}

}  // namespace petal::compare
