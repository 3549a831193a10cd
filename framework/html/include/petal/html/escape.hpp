// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace petal::html {

/// Text for the inside of an element or of a quoted attribute: & < > " ' are written as entities,
/// bytes that are no UTF-8 and control characters as U+FFFD. What comes from a file (a label, a
/// scene's name, a reason) goes through here.
std::string escape(std::string_view text);

/// JSON for the inside of a <script type="application/json">: '<', '>' and '&' become \u003c and so
/// on, which parses to the same value, so that no text of it can end the script.
std::string json_for_script(std::string_view json);

/// RFC 4648, with padding.
std::string base64(const std::vector<unsigned char>& bytes);

}  // namespace petal::html
