// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "expand.hpp"

#include <cstdlib>
#include <vector>

#include "json_tree.hpp"

namespace petal {
namespace {

bool is_variable_name(const std::string& name) {
    const std::string first = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz_";
    return !name.empty() && first.find(name.front()) != std::string::npos &&
           name.find_first_not_of(first + "0123456789") == std::string::npos;
}

/// The value of one `${name}`, put at the end of `result`.
void append_value(const std::string& name, const Expansions& expansions, Expanded& result) {
    const std::string environment = "env:";
    if (name == "data" || name == "out") {
        const auto& value = name == "data" ? expansions.data : expansions.out;
        if (name == "data" && !value) result.asks_data = true;
        result.text += value ? *value : "${" + name + "}";
    } else if (name.compare(0, environment.size(), environment) == 0) {
        const std::string variable = name.substr(environment.size());
        if (!is_variable_name(variable)) {
            result.fault = "'${" + printable(name) + "}' names no environment variable; expected " +
                           "letters, digits and '_' after 'env:'";
        } else if (const char* value = std::getenv(variable.c_str())) {
            result.text += value;
        } else {
            result.fault = "the environment variable " + printable(variable) +
                           " is not set; expected a value for '${" + printable(name) + "}'";
        }
    } else {
        const std::vector<std::string> known{"data", "out", "env:NAME"};
        result.fault = "'${" + printable(name) + "}' is unknown" + expected_one_of(name, known);
    }
}

}  // namespace

Expanded expand(const std::string& text, const Expansions& expansions) {
    Expanded result;
    std::size_t at = 0;
    while (result.fault.empty()) {
        const std::size_t start = text.find("${", at);
        result.text += text.substr(at, start == std::string::npos ? start : start - at);
        if (start == std::string::npos) break;
        const std::size_t end = text.find('}', start);
        if (end == std::string::npos) {
            result.fault = "'" + printable(text.substr(start)) + "' has no end; expected '}'";
            break;
        }
        append_value(text.substr(start + 2, end - start - 2), expansions, result);
        at = end + 1;
    }
    return result;
}

}  // namespace petal
