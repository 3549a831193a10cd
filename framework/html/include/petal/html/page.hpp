// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace petal::html {

/// A page that opens from disk and asks for nothing: style, scripts and data stand in it, and its
/// policy refuses all else. It reads without scripts. The style fits dark and light, narrow windows
/// and paper.
struct Page {
    std::string title;   ///< as plain text
    std::string header;  ///< HTML: begins the page
    /// HTML; `heading` is plain text, `id` what the contents link to.
    struct Section {
        std::string id;
        std::string heading;
        std::string body;
    };
    std::vector<Section> sections;
    std::string footer;  ///< HTML
    /// The JSON document that the page was made from, and the name of the file that holds the same.
    std::string document;
    std::string document_name;
    std::string style;                      ///< CSS behind the shared one
    std::vector<std::string_view> scripts;  ///< before the shared one; must not hold "</script"
};

std::string page_text(const Page& page);

/// <table> with a heading row; `cells` and `head` are HTML. Wide tables scroll by themselves. A
/// cell of a column in `left` is set left, the others right.
std::string table(const std::string& caption, const std::vector<std::string>& head,
                  const std::vector<std::vector<std::string>>& cells,
                  const std::vector<std::size_t>& left = {0});

}  // namespace petal::html
