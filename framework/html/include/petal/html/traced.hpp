// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

namespace petal::html {

/// How a number is shown: times `scale` (1000 for millimetres of metres), with so many decimals,
/// and behind it the unit.
struct NumberStyle {
    double scale = 1.0;
    int decimals = 2;
    const char* unit = "";
    bool with_sign = false;
};

/// Writes what a JSON document says into a page, so that each number and sentence names where it
/// stands in the document: <data value="0.1655..." data-from="/residuals/rms_px">0.17</data>. The
/// page holds the document itself too; who reads the page can hold one against the other, by
/// program.
class Traced {
   public:
    /// The document must outlive this.
    explicit Traced(const nlohmann::ordered_json& document) : document_(document) {}

    /// What stands there; null where nothing does.
    const nlohmann::ordered_json& at(const std::string& pointer) const;

    /// A number; "none" where it is null or missing, "inf" and "-inf" as they are.
    std::string number(const std::string& pointer, const NumberStyle& style = {}) const;
    /// A number with so many significant digits, for figures of which nothing is known.
    std::string general(const std::string& pointer, int digits = 4, bool with_sign = false) const;
    /// A text, escaped.
    std::string text(const std::string& pointer) const;
    /// A count that is made from the value there, e.g. of the members of a list; `what` tells how.
    static std::string count(const std::string& pointer, const std::string& what,
                             std::size_t value);

   private:
    const nlohmann::ordered_json& document_;
};

/// A key as a part of a JSON pointer (RFC 6901): ~ and / are escaped.
std::string pointer_part(std::string_view key);

}  // namespace petal::html
