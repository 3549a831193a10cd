// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include <limits>

#include "nearest.hpp"
#include "number_text.hpp"
#include "param_check.hpp"

namespace petal {
namespace {

/// "0.001 to 10 m", "at least 1"; the bounds of the type `int` itself are told where `whole`.
std::string range(const ParamSpec& param, bool whole) {
    const bool integer = param.kind == Kind::integer && !whole;
    const bool has_min = param.min && !(integer && *param.min <= std::numeric_limits<int>::min());
    const bool has_max = param.max && !(integer && *param.max >= std::numeric_limits<int>::max());
    const std::string unit = param.unit.empty() || param.unit == "1" ? "" : " " + param.unit;
    if (has_min && has_max)
        return number_text(*param.min) + " to " + number_text(*param.max) + unit;
    if (has_min) return "at least " + number_text(*param.min) + unit;
    if (has_max) return "at most " + number_text(*param.max) + unit;
    return unit.empty() ? "" : "in" + unit;
}

}  // namespace

std::string expected_value(const ParamSpec& param, bool list, bool whole) {
    const std::string in_range = range(param, whole);
    const std::string bounds = in_range.empty() ? "" : ", " + in_range;
    switch (param.kind) {
        case Kind::boolean:
            return list ? "a list of true and false" : "true or false";
        case Kind::integer:
            return (list ? "a list of integers" : "an integer") + bounds;
        case Kind::real:
            return (list ? "a list of numbers" : "a number") + bounds;
        case Kind::text:
            return list ? "a list of strings" : "a string";
        case Kind::path:
            return list ? "a list of paths (strings)" : "a path (a string)";
        case Kind::choice:
            return (list ? "a list of some of " : "one of ") + join(param.choices);
    }
    return "";
}

}  // namespace petal
