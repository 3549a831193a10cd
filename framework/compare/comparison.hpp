// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "pipeline_reader.hpp"

namespace petal::compare {

/// Which way a metric is better; `none`: differences are told, not judged.
enum class Direction { lower, higher, none };
const char* to_string(Direction direction);

/// What makes a unit a failure, each including those before it.
enum class FailsOn {
    error,       ///< the run failed or crashed
    not_usable,  ///< its verdict is not_usable
    weak,        ///< its verdict is weak
};
const char* to_string(FailsOn fails_on);

struct MetricSpec {
    std::string name;  ///< a key of result.json's "metrics"; or, from '/', a JSON pointer into it
    std::string unit;  ///< told, not used
    Direction better = Direction::none;
    double margin = 0.0;           ///< differences up to this do not matter; in the metric's unit
    bool margin_is_share = false;  ///< of the median of the reference instead
};

/// The value of a swept parameter that a variant stands for.
struct SweepPoint {
    std::string param;  ///< STAGE.PARAM
    std::string value;  ///< JSON
};

struct Variant {
    std::string name;
    std::filesystem::path pipeline;
    std::vector<PipelineChange> base_changes;  ///< come before those of the data
    std::vector<PipelineChange> changes;       ///< come after them
    std::optional<SweepPoint> swept;
};

struct DataItem {
    std::string name;
    std::string folder;                 ///< ${data}; as written: may hold ${env:NAME}; empty: none
    std::filesystem::path relative_to;  ///< what a relative folder is relative to
    std::string where;                  ///< FILE:LINE of the folder, for messages
    std::vector<PipelineChange> changes;
    std::vector<std::uint64_t> seeds;  ///< empty: the comparison's
};

/// A comparison file, or what the quick form of the command line asks for.
struct Comparison {
    std::string name;  ///< the file's stem; the quick form: A-B
    std::string about;
    std::vector<Variant> variants;
    std::size_t reference = 0;  ///< of variants
    std::vector<DataItem> data;
    std::vector<std::uint64_t> seeds;
    std::vector<MetricSpec> metrics;  ///< none: all of result.json's "metrics", direction none
    std::uint64_t seed = 1;           ///< of the bootstrap
    double confidence = 0.95;
    FailsOn fails_on = FailsOn::not_usable;
    double failure_margin = 0.0;  ///< share of pairs that a variant may fail more often

    const std::vector<std::uint64_t>& seeds_of(const DataItem& item) const {
        return item.seeds.empty() ? seeds : item.seeds;
    }
};

}  // namespace petal::compare
