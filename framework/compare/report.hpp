// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <map>
#include <string>
#include <vector>

#include "figures.hpp"
#include "plan.hpp"
#include "unit_runs.hpp"

namespace petal::compare {

/// compare.json: the same units give the same bytes. Infinite ends of intervals (of what counts
/// failures) are "inf" and "-inf".
std::string compare_json(const Comparison& comparison, const Plan& plan, const Figures& figures,
                         const std::vector<UnitOutcome>& outcomes);

/// One row a unit: data, seed, variant, failure, value, the reference's value, the difference.
std::string metric_csv(const Comparison& comparison, const MetricSpec& metric,
                       const std::vector<UnitOutcome>& outcomes);
/// A file name for a metric: what is no letter, digit, '.', '-' or '_' becomes '_'.
std::string csv_name(const MetricSpec& metric);

/// A picture that a stage drew in a unit that failed.
struct UnitPicture {
    std::string path;  ///< from the comparison's folder
    std::vector<unsigned char> bytes;
};
using UnitPictures = std::map<std::string, std::vector<UnitPicture>>;  ///< by the unit's key

/// report.html, one file that asks for nothing else: verdicts, intervals, box plots, distributions,
/// curves of swept parameters, failures with their reason and picture. Its tables are made from
/// `document`, the text of compare.json, which it holds.
std::string report_html(const Comparison& comparison, const Figures& figures,
                        const std::vector<UnitOutcome>& outcomes, const std::string& document,
                        const UnitPictures& pictures);

/// What the user reads at the end: a table for each metric, one of the failures, and for each swept
/// parameter.
std::string table_text(const Comparison& comparison, const Figures& figures);

/// The comparison's own run.json: units, and how many firings sharing saved.
std::string run_json(const Comparison& comparison, const Plan& plan, const UnitRuns& runs,
                     const std::string& status, double wall_s);

/// timing.json, from the units of the serial pass.
std::string timing_json(const Comparison& comparison, const Plan& plan,
                        const std::map<std::string, UnitRecord>& records, double load_before,
                        double load_after);

/// Seeds that would decide: the pairs, spread over the data.
std::size_t more_seeds(const Comparison& comparison, const MetricJudgement& judgement);

}  // namespace petal::compare
