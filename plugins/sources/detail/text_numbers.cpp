// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "sources/detail/text_numbers.hpp"

#include <algorithm>
#include <charconv>

#include "petal/error.hpp"
#include "petal/rawlog/input_file.hpp"

namespace petal {
namespace {

constexpr std::string_view kBlanks = " \t\r\v\f";

std::string_view trim(std::string_view text) {
    const std::size_t begin = text.find_first_not_of(kBlanks);
    if (begin == std::string_view::npos) return {};
    return text.substr(begin, text.find_last_not_of(kBlanks) - begin + 1);
}

std::vector<std::string_view> split_at(std::string_view line, char separator) {
    std::vector<std::string_view> words;
    for (std::size_t begin = 0;;) {
        const std::size_t end = line.find(separator, begin);
        words.push_back(trim(line.substr(begin, end - begin)));
        if (end == std::string_view::npos) break;
        begin = end + 1;
    }
    if (words.size() > 1 && words.back().empty()) words.pop_back();
    return words;
}

constexpr const char* kDecimalHint =
    "write decimals with points, separate columns by spaces or semicolons";

/// Whether columns are separated by commas, so that a decimal comma would make two of one.
bool comma_separated(std::string_view line) {
    return line.find(';') == std::string_view::npos && line.find(',') != std::string_view::npos;
}

/// Whether a first row looks like 3 or 4 numbers with decimal commas: 2,215,0,750,-0,350. A header
/// of as many names as the row has columns says otherwise.
bool may_be_decimal_commas(std::string_view line, const std::vector<std::string_view>& words,
                           const std::vector<std::string>& header) {
    return comma_separated(line) && (words.size() == 6 || words.size() == 8) &&
           (header.empty() || header.size() * 2 == words.size()) &&
           line.find('.') == std::string_view::npos;
}

}  // namespace

std::optional<double> parse_number(std::string_view text) {
    if (!text.empty() && text.front() == '+') text.remove_prefix(1);
    double value = 0.0;
    const char* end = text.data() + text.size();
    const auto [stop, error] = std::from_chars(text.data(), end, value);
    if (text.empty() || error != std::errc() || stop != end) return std::nullopt;
    return value;
}

std::vector<std::string_view> split_words(std::string_view line) {
    line = trim(line);
    for (const char separator : {';', ','})
        if (line.find(separator) != std::string_view::npos) return split_at(line, separator);
    std::vector<std::string_view> words;
    while (!line.empty()) {
        const std::size_t end = std::min(line.find_first_of(kBlanks), line.size());
        words.push_back(line.substr(0, end));
        line = trim(line.substr(end));
    }
    return words;
}

std::string lower_case(std::string text) {
    for (char& c : text) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
    return text;
}

std::string in_quotes(std::string_view text) {
    constexpr std::size_t longest = 40;
    std::string shown;
    for (const char c : text.substr(0, longest))
        shown += (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) ? '?' : c;
    return "'" + shown + (text.size() > longest ? "...'" : "'");
}

TextTable read_text_table(const std::filesystem::path& file, const std::string& what,
                          std::size_t min_columns) {
    const std::string bytes = read_whole_file(file, what);
    std::string_view rest = bytes;
    constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";
    if (rest.substr(0, byte_order_mark.size()) == byte_order_mark)
        rest.remove_prefix(byte_order_mark.size());

    TextTable table;
    bool first = true;
    std::size_t number = 0;
    const auto fail = [&](const std::string& text) {
        throw Error(file.string() + ":" + std::to_string(number) + ": " + text);
    };
    while (!rest.empty()) {
        const std::size_t end = std::min(rest.find('\n'), rest.size());
        std::string_view line = rest.substr(0, end);
        rest.remove_prefix(std::min(end + 1, rest.size()));
        ++number;
        line = trim(line.substr(0, line.find('#')));
        if (line.empty()) continue;
        const std::vector<std::string_view> words = split_words(line);
        // A word that begins like a number is a slip in the first row, not a header.
        const bool header = std::none_of(words.begin(), words.end(), [](std::string_view word) {
            return parse_number(word).has_value() ||
                   std::string_view("+-.0123456789").find(word.substr(0, 1)) !=
                       std::string_view::npos;
        });
        if (first && header) {
            table.header.assign(words.begin(), words.end());
            first = false;
            continue;
        }
        first = false;
        if (table.columns == 0) {
            if (words.size() < min_columns)
                fail(std::to_string(words.size()) + " columns; " + what + " needs at least " +
                     std::to_string(min_columns));
            if (may_be_decimal_commas(line, words, table.header))
                fail(std::to_string(words.size()) +
                     " whole numbers between commas look like decimal commas; " + kDecimalHint);
            table.columns = words.size();
        }
        if (words.size() != table.columns)
            fail(std::to_string(words.size()) + " columns, but the rows before have " +
                 std::to_string(table.columns));
        for (const std::string_view word : words) {
            const std::optional<double> value = parse_number(word);
            if (!value && word.find(',') != std::string_view::npos)
                fail(in_quotes(word) + " is no number; write decimals with a point, not a comma");
            if (!value && comma_separated(line) && word.find_first_of(kBlanks) != word.npos)
                fail(in_quotes(word) +
                     " is no number; where commas are decimal commas: " + kDecimalHint);
            if (!value) fail(in_quotes(word) + " is no number");
            table.values.push_back(*value);
        }
    }
    return table;
}

}  // namespace petal
