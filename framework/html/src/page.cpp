// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "petal/html/page.hpp"

#include <algorithm>

#include "petal/html/escape.hpp"
#include "petal_html_files.hpp"

namespace petal::html {

std::string page_text(const Page& page) {
    std::string contents;
    std::string body;
    for (const Page::Section& section : page.sections) {
        contents +=
            "<li><a href=\"#" + section.id + "\">" + escape(section.heading) + "</a></li>\n";
        body += "<section id=\"" + section.id + "\">\n<h2>" + escape(section.heading) + "</h2>\n" +
                section.body + "</section>\n";
    }
    std::string text =
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
        "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; img-src data:; "
        "style-src 'unsafe-inline'; script-src 'unsafe-inline'\">\n"
        "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
        "<meta name=\"color-scheme\" content=\"light dark\">\n"
        "<link rel=\"icon\" href=\"data:,\">\n<title>" +
        escape(page.title) + "</title>\n<style>\n";
    text.append(kPageStyle).append(page.style);
    text +=
        "</style>\n</head>\n<body>\n<a class=\"skip\" href=\"#main\">Skip to the "
        "content</a>\n<header>\n" +
        page.header + "</header>\n<nav aria-label=\"Contents\">\n<ul>\n" + contents +
        "</ul>\n</nav>\n<main id=\"main\">\n" + body +
        "<section id=\"document\">\n<h2>All figures</h2>\n<p>This page was made from the "
        "document below, the content of <code>" +
        escape(page.document_name) +
        "</code>. Each figure above names the place it comes from: point at it.</p>\n"
        "<p id=\"document-actions\"></p>\n<details id=\"document-text\"><summary>Show " +
        escape(page.document_name) +
        "</summary><pre tabindex=\"0\"></pre></details>\n</section>\n</main>\n" + "<footer>\n" +
        page.footer + "</footer>\n<script type=\"application/json\" id=\"data\" data-name=\"" +
        escape(page.document_name) + "\">\n" + json_for_script(page.document) + "</script>\n";
    for (const std::string_view script : page.scripts)
        text.append("<script>\n").append(script).append("</script>\n");
    text.append("<script>\n").append(kPageScript).append("</script>\n</body>\n</html>\n");
    return text;
}

std::string table(const std::string& caption, const std::vector<std::string>& head,
                  const std::vector<std::vector<std::string>>& cells,
                  const std::vector<std::size_t>& left) {
    const auto is_left = [&](std::size_t column) {
        return std::find(left.begin(), left.end(), column) != left.end();
    };
    const auto cell = [&](const char* tag, std::size_t column, const std::string& content) {
        const bool row_head = column == 0 && *tag == 't' && tag[1] == 'd';
        const std::string name = row_head ? "th" : tag;
        return "<" + name +
               (row_head        ? " scope=\"row\""
                : tag[1] == 'h' ? " scope=\"col\""
                                : "") +
               (is_left(column) ? " class=\"left\">" : ">") + content + "</" + name + ">";
    };
    std::string text = "<div class=\"wide\" tabindex=\"0\" role=\"region\" aria-label=\"" +
                       escape(caption) + "\"><table>\n<caption>" + escape(caption) +
                       "</caption>\n<thead><tr>";
    for (std::size_t i = 0; i < head.size(); ++i) text += cell("th", i, head[i]);
    text += "</tr></thead>\n<tbody>\n";
    for (const auto& row : cells) {
        text += "<tr>";
        for (std::size_t i = 0; i < row.size(); ++i) text += cell("td", i, row[i]);
        text += "</tr>\n";
    }
    return text + "</tbody>\n</table></div>\n";
}

}  // namespace petal::html
