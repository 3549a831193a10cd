// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace petal {

/// A number as text, whatever the locale: "1e-3", "+2", "nan", "-inf". None when it is no number.
std::optional<double> parse_number(std::string_view text);

/// The words of a line: split at commas, else at semicolons, else at white space; blanks around a
/// word go, and so does one empty word at the end ("1,2,3,").
std::vector<std::string_view> split_words(std::string_view line);

/// ASCII letters in lower case, whatever the locale.
std::string lower_case(std::string text);

/// `text` for an error message: quoted, shortened, without control characters.
std::string in_quotes(std::string_view text);

/// A rectangle of numbers read from text.
struct TextTable {
    std::vector<std::string> header;  ///< the words of a first line that is no numbers; often empty
    std::size_t columns = 0;
    std::vector<double> values;  ///< row by row

    std::size_t rows() const { return columns == 0 ? 0 : values.size() / columns; }
    double at(std::size_t row, std::size_t column) const { return values[row * columns + column]; }
};

/// Reads lines of numbers separated by commas, semicolons, blanks or tabs. Empty lines and what
/// follows a '#' are left out; the first line that is left may be a header. NaN and infinities
/// are numbers. A file without a row is an empty table.
/// \throws Error with file and line: no number, another count of columns than in the first row,
/// fewer than `min_columns`, decimal commas.
TextTable read_text_table(const std::filesystem::path& file, const std::string& what,
                          std::size_t min_columns);

}  // namespace petal
