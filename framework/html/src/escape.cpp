// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "petal/html/escape.hpp"

namespace petal::html {

namespace {

/// Length of the UTF-8 sequence at the begin of `text`; 0 where it is none (overlong, a surrogate,
/// cut short).
std::size_t sequence_length(std::string_view text) {
    const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
    const unsigned char first = byte(0);
    if (first < 0x80) return 1;
    std::size_t length = 0;
    std::uint32_t code = 0;
    if ((first & 0xE0U) == 0xC0U) {
        length = 2;
        code = first & 0x1FU;
    } else if ((first & 0xF0U) == 0xE0U) {
        length = 3;
        code = first & 0x0FU;
    } else if ((first & 0xF8U) == 0xF0U) {
        length = 4;
        code = first & 0x07U;
    }
    if (length == 0 || text.size() < length) return 0;
    for (std::size_t i = 1; i < length; ++i) {
        if ((byte(i) & 0xC0U) != 0x80U) return 0;
        code = code << 6U | (byte(i) & 0x3FU);
    }
    const bool overlong = code < (length == 2 ? 0x80U : length == 3 ? 0x800U : 0x10000U);
    const bool surrogate = code >= 0xD800U && code <= 0xDFFFU;
    return overlong || surrogate || code > 0x10FFFFU ? 0 : length;
}

constexpr std::string_view kReplacement = "\xEF\xBF\xBD";

}  // namespace

std::string escape(std::string_view text) {
    std::string escaped;
    escaped.reserve(text.size() + text.size() / 8);
    while (!text.empty()) {
        const std::size_t length = sequence_length(text);
        const char c = text.front();
        if (length == 0) {
            escaped += kReplacement;
        } else if (c == '&') {
            escaped += "&amp;";
        } else if (c == '<') {
            escaped += "&lt;";
        } else if (c == '>') {
            escaped += "&gt;";
        } else if (c == '"') {
            escaped += "&quot;";
        } else if (c == '\'') {
            escaped += "&#39;";
        } else if ((c >= 0 && c < 0x20 && c != '\n' && c != '\t') || c == 0x7F) {
            escaped += kReplacement;
        } else {
            escaped += text.substr(0, length);
        }
        text.remove_prefix(length == 0 ? 1 : length);
    }
    return escaped;
}

std::string json_for_script(std::string_view json) {
    std::string safe;
    safe.reserve(json.size() + 64);
    std::size_t from = 0;  // what needs nothing goes over in one piece
    for (std::size_t i = 0; i < json.size(); ++i) {
        const char c = json[i];
        const char* told = c == '<'   ? "\\u003c"
                           : c == '>' ? "\\u003e"
                           : c == '&' ? "\\u0026"
                                      : nullptr;
        if (told == nullptr) continue;
        safe.append(json, from, i - from).append(told);
        from = i + 1;
    }
    safe.append(json, from, json.size() - from);
    return safe;
}

std::string base64(const std::vector<unsigned char>& bytes) {
    static constexpr char kDigits[] =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text((bytes.size() + 2) / 3 * 4, '=');
    std::size_t out = 0;
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        const std::size_t left = bytes.size() - i;
        const std::uint32_t group = static_cast<std::uint32_t>(bytes[i]) << 16U |
                                    (left > 1 ? static_cast<std::uint32_t>(bytes[i + 1]) : 0U)
                                        << 8U |
                                    (left > 2 ? static_cast<std::uint32_t>(bytes[i + 2]) : 0U);
        for (std::size_t digit = 0; digit < (left > 2 ? 4U : left + 1); ++digit)
            text[out + digit] = kDigits[group >> (18U - 6U * digit) & 0x3FU];
        out += 4;
    }
    return text;
}

}  // namespace petal::html
