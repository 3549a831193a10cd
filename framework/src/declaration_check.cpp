// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "declaration_check.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <set>
#include <type_traits>
#include <variant>

#include "nearest.hpp"
#include "number_text.hpp"

namespace petal {
namespace {

using Faults = std::vector<std::string>;

bool is_name(const std::string& text) {
    return !text.empty() && std::all_of(text.begin(), text.end(), [](char c) {
        return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_';
    });
}

bool is_type(const std::string& text) {
    const auto dot = text.find('.');
    return dot != std::string::npos && is_name(text.substr(0, dot)) &&
           is_name(text.substr(dot + 1));
}

const char* const kNameRule = "is not made of lower case letters, digits and '_'";

void check_ports(const std::vector<PortSpec>& ports, const std::string& word, Faults& faults) {
    std::set<std::string> names;
    for (const PortSpec& port : ports) {
        const std::string who = word + " port '" + port.name + "' ";
        if (!is_name(port.name)) faults.push_back(who + kNameRule);
        if (!names.insert(port.name).second) faults.push_back(who + "is declared twice");
        if (port.type.empty())
            faults.push_back(who + "has no type: PacketTraits<T>::name of its packet is empty");
        if (port.doc.empty()) faults.push_back(who + "has no documentation");
    }
}

/// One element of a default: a default that the stage would refuse from a user is a mistake.
template <class T>
void check_element(const ParamSpec& param, const T& value, const std::string& who, Faults& faults) {
    if constexpr (std::is_same_v<T, double> || std::is_same_v<T, std::int64_t>) {
        const double as_double = static_cast<double>(value);
        if (!std::isfinite(as_double)) {
            faults.push_back(who + "has the default " + number_text(as_double) +
                             ", which is not a finite number");
            return;
        }
        if (param.min && as_double < *param.min)
            faults.push_back(who + "has the default " + number_text(as_double) +
                             " below its least value " + number_text(*param.min));
        if (param.max && as_double > *param.max)
            faults.push_back(who + "has the default " + number_text(as_double) +
                             " above its greatest value " + number_text(*param.max));
    } else if constexpr (std::is_same_v<T, std::string>) {
        const auto& choices = param.choices;
        if (param.kind == Kind::choice &&
            std::find(choices.begin(), choices.end(), value) == choices.end())
            faults.push_back(who + "has the default '" + value +
                             "', which is none of its choices (" + join(choices) + ")");
    }
}

void check_default(const ParamSpec& param, const std::string& who, Faults& faults) {
    std::visit(
        [&](const auto& value) {
            using T = std::decay_t<decltype(value)>;
            if constexpr (std::is_same_v<T, std::vector<std::int64_t>> ||
                          std::is_same_v<T, std::vector<double>> ||
                          std::is_same_v<T, std::vector<std::string>>) {
                for (const auto& element : value) check_element(param, element, who, faults);
            } else {
                check_element(param, value, who, faults);
            }
        },
        param.default_value);
}

void check_param(const ParamSpec& param, Faults& faults) {
    const std::string who = "parameter '" + param.name + "' ";
    if (!is_name(param.name)) faults.push_back(who + kNameRule);
    if (param.doc.empty()) faults.push_back(who + "has no documentation");
    if (param.kind == Kind::real) {
        if (param.unit.empty())
            faults.push_back(who + "is a double without a unit (\"1\" where it has none)");
        if (!param.min && !param.max)
            faults.push_back(who + "is a double without a range; call within() or at_least()");
    }
    const auto not_a_number = [](const std::optional<double>& bound) {
        return bound && std::isnan(*bound);
    };
    if (not_a_number(param.min) || not_a_number(param.max))
        faults.push_back(who + "has a bound that is not a number");
    if (param.min && param.max && *param.min > *param.max)
        faults.push_back(who + "has the empty range " + number_text(*param.min) + " to " +
                         number_text(*param.max));
    if (param.kind == Kind::choice && param.choices.empty())
        faults.push_back(who + "is a choice without choices");
    check_default(param, who, faults);
}

}  // namespace

std::vector<std::string> declaration_faults(const StageSpec& spec) {
    Faults faults;
    if (!is_type(spec.type))
        faults.push_back(
            "its type is not of the form kind.name, in lower case letters, digits and '_'");
    if (spec.summary.empty()) faults.push_back("it has no summary");
    if (!spec.role.empty() && !is_name(spec.role))
        faults.push_back("role '" + spec.role + "' " + kNameRule);
    if (spec.inputs.empty() && spec.outputs.empty()) faults.push_back("it has no port at all");
    check_ports(spec.inputs, "input", faults);
    check_ports(spec.outputs, "output", faults);
    std::set<std::string> names;
    for (const ParamSpec& param : spec.params) {
        check_param(param, faults);
        if (!names.insert(param.name).second)
            faults.push_back("parameter '" + param.name + "' is declared twice");
    }
    if (spec.make_params && spec.check_params) {
        const auto defaults = spec.make_params();
        for (const std::string& violated : spec.check_params(defaults.get()))
            faults.push_back("its defaults break its own check: " + violated);
    }
    return faults;
}

}  // namespace petal
