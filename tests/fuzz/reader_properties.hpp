// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <string>

#include "unit/pipeline_fakes.hpp"

namespace petal::fuzz {

/// Ends the program with a message, for libFuzzer to keep the input.
inline void require(bool holds, const char* what, const std::string& text = "") {
    if (holds) return;
    std::fprintf(stderr, "broken: %s\n%s\n", what, text.c_str());
    std::abort();
}

/// What a user may see in a terminal: one line, no control characters, no flood.
inline void require_readable(const Problem& problem) {
    const std::string text = to_string(problem);
    constexpr std::size_t kLongest = 20000;  // a cycle is told with all its ids
    require(!problem.message.empty(), "a problem has a message");
    require(text.size() < kLongest, "a problem is told shortly", text.substr(0, kLongest));
    const bool controls = std::any_of(text.begin(), text.end(), [](char c) {
        return static_cast<unsigned char>(c) < 0x20 || c == 0x7F;
    });
    require(!controls, "a problem has no control characters", text);
    require(problem.line >= 0, "lines count from 1");
}

/// Reads and checks what holds for every text: a pipeline or problems, and problems that can be
/// shown. \returns the effective pipeline, empty where there were problems.
inline std::string read_and_check(const pipeline_fakes::Input& input) {
    const CheckedPipeline checked = pipeline_fakes::read(input);
    require(checked.pipeline.has_value() == checked.problems.empty(),
            "either a pipeline or its problems");
    for (const Problem& problem : checked.problems) require_readable(problem);
    if (!checked.pipeline) return {};
    require(!to_dot(*checked.pipeline).empty(), "a pipeline has a graph");
    return checked.pipeline->effective_json;
}

/// The effective pipeline is a pipeline, and its own effective pipeline; an empty patch changes
/// nothing, nor does the pipeline as a patch of itself.
inline void require_idempotent(const std::string& effective) {
    if (effective.empty()) return;
    require(read_and_check({effective, {}, {}}) == effective,
            "the effective pipeline reads back the same", effective);
    require(read_and_check({effective, {"{}"}, {}}) == effective, "an empty patch changes nothing",
            effective);
    require(read_and_check({effective, {effective}, {}}) == effective,
            "a pipeline patched by itself stays the same", effective);
}

}  // namespace petal::fuzz
