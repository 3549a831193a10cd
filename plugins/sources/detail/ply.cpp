// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include <cmath>
#include <map>

#include "petal/error.hpp"
#include "sources/detail/cloud_file.hpp"
#include "sources/detail/record_layout.hpp"
#include "sources/detail/text_numbers.hpp"

namespace petal {
namespace {

namespace fs = std::filesystem;

/// The scalar types of PLY, in both spellings.
const std::map<std::string_view, std::pair<char, std::size_t>>& ply_types() {
    static const std::map<std::string_view, std::pair<char, std::size_t>> types = {
        {"char", {'I', 1}},  {"int8", {'I', 1}},    {"uchar", {'U', 1}},  {"uint8", {'U', 1}},
        {"short", {'I', 2}}, {"int16", {'I', 2}},   {"ushort", {'U', 2}}, {"uint16", {'U', 2}},
        {"int", {'I', 4}},   {"int32", {'I', 4}},   {"uint", {'U', 4}},   {"uint32", {'U', 4}},
        {"float", {'F', 4}}, {"float32", {'F', 4}}, {"double", {'F', 8}}, {"float64", {'F', 8}}};
    return types;
}

class PlyReader {
   public:
    PlyReader(const fs::path& file, std::string_view bytes) : file_(file), rest_(bytes) {}

    CloudFile read() {
        if (next_line() != "ply") fail("the first line must be 'ply'; is this a PLY file?");
        while (!header_ended_) header_line();
        if (format_.empty()) fail("no format line in the PLY header");
        if (!seen_vertices_) fail("no element 'vertex' in the PLY header");
        if (layout_.records == 0) return {};
        if (format_ == "ascii") return read_text_records(file_, layout_, rest_, line_ + 1);
        layout_.big_endian = format_ == "binary_big_endian";
        return read_binary_records(file_, layout_, rest_);
    }

   private:
    [[noreturn]] void fail(const std::string& text) const {
        throw Error(file_.string() + ":" + std::to_string(line_) + ": " + text);
    }

    std::string_view next_line() {
        const std::size_t end = rest_.find('\n');
        ++line_;
        if (end == std::string_view::npos) fail("the PLY header ends before its end_header line");
        std::string_view line = rest_.substr(0, end);
        rest_.remove_prefix(end + 1);
        while (!line.empty() && (line.back() == '\r' || line.back() == ' ')) line.remove_suffix(1);
        return line;
    }

    void header_line() {
        const std::vector<std::string_view> words = split_words(next_line());
        if (words.empty() || words[0] == "comment" || words[0] == "obj_info") return;
        if (words[0] == "end_header") {
            header_ended_ = true;
        } else if (words[0] == "format" && words.size() == 3) {
            format_ = words[1];
            if (format_ != "ascii" && format_ != "binary_little_endian" &&
                format_ != "binary_big_endian")
                fail("unknown PLY format " + in_quotes(words[1]));
        } else if (words[0] == "element" && words.size() == 3) {
            element(words);
        } else if (words[0] == "property" && words.size() >= 3) {
            if (in_vertices_) property(words);
        } else {
            fail("unknown PLY header line " + in_quotes(words[0]));
        }
    }

    void element(const std::vector<std::string_view>& words) {
        const auto count = parse_number(words[2]);
        if (!count || !(*count >= 0.0 && *count < 4294967296.0) || std::floor(*count) != *count)
            fail(in_quotes(words[2]) + " is no count");
        in_vertices_ = words[1] == "vertex";
        // What comes after the vertices (faces) is never read; what comes before would have to be
        // skipped.
        if (!in_vertices_ && !seen_vertices_ && *count > 0.0)
            fail("element " + in_quotes(words[1]) +
                 " comes before the vertices; export points only");
        if (!in_vertices_) return;
        seen_vertices_ = true;
        layout_.records = static_cast<std::size_t>(*count);
    }

    void property(const std::vector<std::string_view>& words) {
        if (words[1] == "list") fail("a list among the vertices' properties is not read");
        const auto type = ply_types().find(words[1]);
        if (type == ply_types().end()) fail("unknown PLY type " + in_quotes(words[1]));
        layout_.fields.push_back(
            {std::string(words[2]), type->second.first, type->second.second, 1});
    }

    const fs::path& file_;
    std::string_view rest_;
    std::size_t line_ = 0;
    RecordLayout layout_;
    std::string format_;
    bool header_ended_ = false;
    bool in_vertices_ = false;
    bool seen_vertices_ = false;
};

}  // namespace

// MRPT has a PLY loader too, but 2.5.8 ends the process on a file that is no PLY and leaves zeros
// for the points that a truncated file lacks.
CloudFile read_ply(const fs::path& file, const std::string& bytes) {
    return PlyReader(file, bytes).read();
}

}  // namespace petal
