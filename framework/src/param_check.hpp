// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>

#include "expand.hpp"
#include "json_tree.hpp"
#include "petal/spec.hpp"

namespace petal {

/// The parameters of one stage.
struct CheckedParams {
    std::map<std::string, Value>
        written;  ///< every parameter, as the pipeline or the default has it
    std::map<std::string, Value> expanded;  ///< the same, `${...}` replaced
    std::shared_ptr<void> params;  ///< the stage's Params struct; null where something is wrong
};

/// Checks values against declarations. One instance for a whole pipeline.
class ParamCheck {
   public:
    /// With `need_data` the first use of `${data}` is a problem where it has no value.
    ParamCheck(Expansions expansions, bool need_data, ProblemList& problems);

    /// `stage` is the stage's JSON, `path` its path.
    CheckedParams check(const StageSpec& spec, const JsonNode& stage, const std::string& path);

   private:
    /// The value of a parameter as written; expands too where it is a text.
    struct Converted {
        Value written;
        Value expanded;
    };
    std::optional<Converted> convert(const ParamSpec& param, const JsonNode& node,
                                     const std::string& path);
    std::optional<Converted> convert_default(const ParamSpec& param, const Origin& origin,
                                             const std::string& path);
    std::optional<Converted> convert_list(const ParamSpec& param, const JsonNode& node,
                                          const std::string& path);
    std::optional<Converted> convert_one(const ParamSpec& param, const JsonNode& node,
                                         const std::string& path);
    std::optional<Converted> convert_text(const ParamSpec& param, const std::string& text,
                                          const Origin& origin, const std::string& path);

    Expansions expansions_;
    bool tell_data_;  ///< `${data}` is needed, and that has not been told yet
    ProblemList& problems_;
};

/// What a parameter takes, for messages: "an integer, at least 1", "a number, 0.001 to 10 m", "one
/// of huber, none"; of a whole list, or of one value. The bounds of `int` itself are
/// told with `whole` only.
std::string expected_value(const ParamSpec& param, bool list, bool whole = false);

}  // namespace petal
