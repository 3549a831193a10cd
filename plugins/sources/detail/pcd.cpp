// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <optional>

#include "petal/error.hpp"
#include "sources/detail/cloud_file.hpp"
#include "sources/detail/record_layout.hpp"
#include "sources/detail/text_numbers.hpp"

namespace petal {
namespace {

namespace fs = std::filesystem;

/// Expands LZF, the compression of binary_compressed PCD: a control byte below 32 begins a run of
/// literal bytes, any other a copy of earlier output. None where the data are damaged.
std::optional<std::string> expand_lzf(std::string_view in, std::size_t expanded_size) {
    std::string out;
    const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(in[i]); };
    for (std::size_t i = 0; i < in.size();) {
        const std::size_t control = byte(i++);
        if (control < 32) {
            const std::size_t run = control + 1;
            if (in.size() - i < run || expanded_size - out.size() < run) return std::nullopt;
            out.append(in.substr(i, run));
            i += run;
            continue;
        }
        std::size_t length = control >> 5;
        if (length == 7) {
            if (i >= in.size()) return std::nullopt;
            length += byte(i++);
        }
        if (i >= in.size()) return std::nullopt;
        const std::size_t distance = ((control & 31U) << 8U) + byte(i++) + 1;
        length += 2;
        if (distance > out.size() || expanded_size - out.size() < length) return std::nullopt;
        // Byte by byte: the copy may overlap what it writes.
        for (std::size_t k = 0; k < length; ++k) out.push_back(out[out.size() - distance]);
    }
    if (out.size() != expanded_size) return std::nullopt;
    return out;
}

class PcdReader {
   public:
    PcdReader(const fs::path& file, std::string_view bytes) : file_(file), rest_(bytes) {}

    CloudFile read() {
        while (data_.empty()) header_line();
        if (layout_.fields.empty()) fail("no FIELDS line before DATA");
        if (layout_.records == 0 && !has_points_) layout_.records = width_ * height_;
        if (layout_.records == 0) return {};
        CloudFile cloud = records();
        cloud.remark = remark_;
        return cloud;
    }

   private:
    [[noreturn]] void fail(const std::string& text) const {
        throw Error(file_.string() + ":" + std::to_string(line_) + ": " + text);
    }

    CloudFile records() const {
        if (data_ == "ascii") return read_text_records(file_, layout_, rest_, line_ + 1);
        if (data_ == "binary") return read_binary_records(file_, layout_, rest_);
        return compressed();
    }

    /// The points lie in the sensor's frame, so the pose is not applied; what it says is told.
    void viewpoint(const std::vector<std::string_view>& words) {
        constexpr std::array<double, 7> identity = {0, 0, 0, 1, 0, 0, 0};  // translation, w x y z
        bool same = words.size() == identity.size() + 1;
        std::string text;
        for (std::size_t i = 1; i < words.size(); ++i) {
            text += (text.empty() ? "" : " ") + std::string(words[i]);
            same = same && parse_number(words[i]) == identity[i - 1];
        }
        remark_ = same ? ""
                       : "VIEWPOINT " + in_quotes(text) +
                             " is not applied; the points stay as they stand";
    }

    std::size_t count(std::string_view word) const {
        const auto value = parse_number(word);
        // Below 2^32: more points than any stage can index.
        if (!value || !(*value >= 0.0 && *value < 4294967296.0) || std::floor(*value) != *value)
            fail(in_quotes(word) + " is no count");
        return static_cast<std::size_t>(*value);
    }

    void header_line() {
        const std::size_t end = rest_.find('\n');
        ++line_;
        if (end == std::string_view::npos)
            fail("the PCD header ends before its DATA line; is this a PCD file?");
        std::string_view line = rest_.substr(0, end);
        rest_.remove_prefix(end + 1);
        line = line.substr(0, line.find('#'));
        const std::vector<std::string_view> words = split_words(line);
        if (words.empty()) return;
        const std::string_view key = words[0];
        const std::size_t values = words.size() - 1;
        auto& fields = layout_.fields;
        if (key == "FIELDS" || key == "COLUMNS") {
            fields.clear();
            for (std::size_t i = 1; i < words.size(); ++i)
                fields.push_back({std::string(words[i]), 'F', 4, 1});
        } else if (key == "SIZE" || key == "TYPE" || key == "COUNT") {
            if (values != fields.size())
                fail(std::string(key) + " has " + std::to_string(values) + " entries, FIELDS " +
                     std::to_string(fields.size()));
            for (std::size_t i = 0; i < values; ++i) {
                if (key == "SIZE") fields[i].size = count(words[i + 1]);
                if (fields[i].size > 8) fail("a SIZE of more than 8 bytes");
                if (key == "COUNT") fields[i].count = count(words[i + 1]);
                if (key == "TYPE") fields[i].kind = words[i + 1][0];
            }
        } else if (key == "WIDTH" || key == "HEIGHT" || key == "POINTS") {
            if (values != 1) fail(std::string(key) + " needs one number");
            const std::size_t value = count(words[1]);
            if (key == "WIDTH") width_ = value;
            if (key == "HEIGHT") height_ = value;
            if (key == "POINTS") {
                layout_.records = value;
                has_points_ = true;
            }
        } else if (key == "DATA") {
            if (values != 1 ||
                (words[1] != "ascii" && words[1] != "binary" && words[1] != "binary_compressed"))
                fail("DATA must be ascii, binary or binary_compressed");
            data_ = words[1];
        } else if (key == "VIEWPOINT") {
            viewpoint(words);
        } else if (key != "VERSION") {
            fail("unknown PCD header line " + in_quotes(key));
        }
    }

    CloudFile compressed() const {
        std::uint32_t sizes[2] = {0, 0};  // compressed, expanded
        if (rest_.size() < sizeof(sizes)) fail("the file ends after its header");
        std::memcpy(sizes, rest_.data(), sizeof(sizes));
        const std::string_view packed = rest_.substr(sizeof(sizes));
        if (packed.size() < sizes[0])
            fail("the file is truncated: " + std::to_string(sizes[0]) +
                 " compressed bytes are expected, " + std::to_string(packed.size()) + " follow");
        const auto data = expand_lzf(packed.substr(0, sizes[0]), sizes[1]);
        if (!data) fail("the compressed points are damaged");
        return read_binary_columns(file_, layout_, *data);
    }

    const fs::path& file_;
    std::string_view rest_;
    std::size_t line_ = 0;
    RecordLayout layout_;
    bool has_points_ = false;
    std::size_t width_ = 0;
    std::size_t height_ = 1;
    std::string data_;
    std::string remark_;
};

}  // namespace

CloudFile read_pcd(const fs::path& file, const std::string& bytes) {
    return PcdReader(file, bytes).read();
}

}  // namespace petal
