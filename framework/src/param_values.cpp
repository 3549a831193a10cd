// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "param_values.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <type_traits>

#include "param_check.hpp"

namespace petal {

namespace {

template <class T>
struct IsVector : std::false_type {};
template <class E>
struct IsVector<std::vector<E>> : std::true_type {};

template <class T>
bool fits(const ParamSpec& param, const T& value) {
    if constexpr (std::is_same_v<T, bool>) {
        return true;
    } else if constexpr (std::is_same_v<T, std::string>) {
        return param.kind != Kind::choice ||
               std::find(param.choices.begin(), param.choices.end(), value) != param.choices.end();
    } else {
        const auto number = static_cast<double>(value);
        return std::isfinite(number) && (!param.min || number >= *param.min) &&
               (!param.max || number <= *param.max);
    }
}

}  // namespace

std::string value_problem(const ParamSpec& param, const Value& value) {
    const auto fits_held = [&param](const auto& held) {
        if constexpr (IsVector<std::decay_t<decltype(held)>>::value) {
            return std::all_of(held.begin(), held.end(),
                               [&](auto element) { return fits(param, element); });
        } else {
            return fits(param, held);
        }
    };
    if (value.index() == param.default_value.index() && std::visit(fits_held, value)) return {};
    return value_text(value) + " does not fit; expected " + expected_value(param, param.list);
}

std::string value_text(const Value& value) {
    return std::visit([](const auto& held) { return nlohmann::json(held).dump(); }, value);
}

}  // namespace petal
