// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "petal/html/traced.hpp"

#include "petal/html/escape.hpp"
#include "petal/printed.hpp"

namespace petal::html {

namespace {

using Json = nlohmann::ordered_json;

std::string with_unit(const char* unit) {
    return *unit == '\0' ? std::string() : "\u00a0" + escape(unit);
}

/// A minus that is as wide as a plus and is not broken off.
std::string with_minus(std::string number) {
    if (!number.empty() && number.front() == '-') number.replace(0, 1, "\u2212");
    return number;
}

std::string data_element(const std::string& pointer, const Json& value, double scale,
                         const std::string& shown) {
    std::string element =
        "<data value=\"" + value.dump() + "\" data-from=\"" + escape(pointer) + "\"";
    if (scale != 1.0) element += printed(" data-scale=\"%g\"", scale);
    return element + ">" + with_minus(shown) + "</data>";
}

}  // namespace

const Json& Traced::at(const std::string& pointer) const {
    static const Json nothing;
    const Json::json_pointer place(pointer);
    return document_.contains(place) ? document_.at(place) : nothing;
}

std::string Traced::number(const std::string& pointer, const NumberStyle& style) const {
    const Json& value = at(pointer);
    if (!value.is_number()) return value.is_string() ? text(pointer) : "none";
    const double scaled = value.get<double>() * style.scale;
    return data_element(pointer, value, style.scale,
                        printed(style.with_sign ? "%+.*f" : "%.*f", style.decimals, scaled)) +
           with_unit(style.unit);
}

std::string Traced::general(const std::string& pointer, int digits, bool with_sign) const {
    const Json& value = at(pointer);
    if (!value.is_number()) return value.is_string() ? text(pointer) : "none";
    return data_element(pointer, value, 1.0,
                        printed(with_sign ? "%+.*g" : "%.*g", digits, value.get<double>()));
}

std::string Traced::text(const std::string& pointer) const {
    const Json& value = at(pointer);
    if (!value.is_string()) return {};
    return "<span data-from=\"" + escape(pointer) + "\">" + escape(value.get<std::string>()) +
           "</span>";
}

std::string Traced::count(const std::string& pointer, const std::string& what, std::size_t value) {
    return "<data value=\"" + std::to_string(value) + "\" data-count=\"" + escape(what) +
           "\" data-of=\"" + escape(pointer) + "\">" + std::to_string(value) + "</data>";
}

std::string pointer_part(std::string_view key) {
    std::string part;
    for (const char c : key) {
        if (c == '~') {
            part += "~0";
        } else if (c == '/') {
            part += "~1";
        } else {
            part += c;
        }
    }
    return part;
}

}  // namespace petal::html
