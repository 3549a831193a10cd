// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "param_values.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <type_traits>

#include "nearest.hpp"

namespace petal {

namespace {

std::string number(double value) {
    std::ostringstream text;
    text.imbue(std::locale::classic());
    text << value;
    return text.str();
}

std::string range_problem(const ParamSpec& param, double value) {
    const bool below = param.min && value < *param.min;
    const bool above = param.max && value > *param.max;
    if (std::isfinite(value) && !below && !above) return {};
    const std::string unit = param.unit.empty() || param.unit == "1" ? "" : " " + param.unit;
    std::string expected;
    if (param.min && param.max) {
        expected = "from " + number(*param.min) + " to " + number(*param.max);
    } else if (param.min) {
        expected = "at least " + number(*param.min);
    } else if (param.max) {
        expected = "at most " + number(*param.max);
    } else {
        expected = "a finite number";
    }
    return number(value) + unit + " is out of range; expected " + expected + unit;
}

std::string element_problem(const ParamSpec& param, double value) { return range_problem(param, value); }
std::string element_problem(const ParamSpec& param, std::int64_t value) {
    return range_problem(param, static_cast<double>(value));
}
std::string element_problem(const ParamSpec&, bool) { return {}; }
std::string element_problem(const ParamSpec& param, const std::string& value) {
    if (param.kind != Kind::choice) return {};
    if (std::find(param.choices.begin(), param.choices.end(), value) != param.choices.end()) return {};
    return "'" + value + "' is no choice; expected one of " + join(param.choices) +
           did_you_mean(value, param.choices);
}

template <class T>
struct IsVector : std::false_type {};
template <class E>
struct IsVector<std::vector<E>> : std::true_type {};

}  // namespace

std::string value_problem(const ParamSpec& param, const Value& value) {
    if (value.index() != param.default_value.index())
        return std::string("wrong kind; expected ") + (param.list ? "a list of " : "") +
               to_string(param.kind);
    return std::visit(
        [&param](const auto& held) -> std::string {
            if constexpr (IsVector<std::decay_t<decltype(held)>>::value) {
                for (const auto& element : held) {
                    const std::string problem = element_problem(param, element);
                    if (!problem.empty()) return problem;
                }
                return {};
            } else {
                return element_problem(param, held);
            }
        },
        value);
}

}  // namespace petal
