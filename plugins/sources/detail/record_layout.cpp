// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "sources/detail/record_layout.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <limits>
#include <optional>

#include "petal/error.hpp"
#include "sources/detail/text_numbers.hpp"

namespace petal {
namespace {

namespace fs = std::filesystem;
using Field = RecordLayout::Field;

/// Which fields hold x, y, z and the intensity (-1: none).
struct Roles {
    std::array<std::size_t, 3> position{};
    std::optional<std::size_t> intensity;
};

Roles find_roles(const fs::path& file, const RecordLayout& layout) {
    Roles roles;
    const auto find = [&](const std::string& name) -> std::optional<std::size_t> {
        for (std::size_t i = 0; i < layout.fields.size(); ++i)
            if (layout.fields[i].name == name) return i;
        return std::nullopt;
    };
    std::string present;
    for (const Field& field : layout.fields) present += (present.empty() ? "" : " ") + field.name;
    const std::array<const char*, 3> names = {"x", "y", "z"};
    for (std::size_t k = 0; k < 3; ++k) {
        const auto at = find(names[k]);
        if (!at)
            throw Error("cloud file " + file.string() + ": no field '" + names[k] +
                        "'; its fields are: " + present);
        if (layout.fields[*at].count != 1)
            throw Error("cloud file " + file.string() + ": field '" + std::string(names[k]) +
                        "' has a count of " + std::to_string(layout.fields[*at].count) +
                        " where 1 is expected");
        roles.position[k] = *at;
    }
    for (const char* name :
         {"intensity", "i", "scalar_intensity", "scalar_Intensity", "reflectivity"})
        if (const auto at = find(name); at && layout.fields[*at].count == 1 && !roles.intensity)
            roles.intensity = at;
    return roles;
}

template <class T>
double load(const char* from, bool swap) {
    std::array<char, sizeof(T)> bytes{};
    std::memcpy(bytes.data(), from, sizeof(T));
    if (swap) std::reverse(bytes.begin(), bytes.end());
    T value{};
    std::memcpy(&value, bytes.data(), sizeof(T));
    return static_cast<double>(value);
}

double load(const fs::path& file, const Field& field, const char* from, bool swap) {
    switch (field.kind) {
        case 'F':
            if (field.size == 4) return load<float>(from, swap);
            if (field.size == 8) return load<double>(from, swap);
            break;
        case 'I':
            if (field.size == 1) return load<std::int8_t>(from, swap);
            if (field.size == 2) return load<std::int16_t>(from, swap);
            if (field.size == 4) return load<std::int32_t>(from, swap);
            if (field.size == 8) return load<std::int64_t>(from, swap);
            break;
        case 'U':
            if (field.size == 1) return load<std::uint8_t>(from, swap);
            if (field.size == 2) return load<std::uint16_t>(from, swap);
            if (field.size == 4) return load<std::uint32_t>(from, swap);
            if (field.size == 8) return load<std::uint64_t>(from, swap);
            break;
        default:
            break;
    }
    throw Error("cloud file " + file.string() + ": field '" + field.name + "' is of type " +
                std::string(1, field.kind) + std::to_string(field.size) + ", which is not known");
}

void require_bytes(const fs::path& file, const RecordLayout& layout, std::size_t there) {
    const std::size_t each = layout.record_bytes();
    if (each == 0) throw Error("cloud file " + file.string() + ": its points have no fields");
    if (layout.records > std::numeric_limits<std::size_t>::max() / each)
        throw Error("cloud file " + file.string() + ": its header promises " +
                    std::to_string(layout.records) + " points, which no file can hold");
    const std::size_t expected = layout.records * each;
    if (there < expected)
        throw Error("cloud file " + file.string() + " is truncated: its header promises " +
                    std::to_string(layout.records) + " points of " + std::to_string(each) +
                    " bytes, that is " + std::to_string(expected) + " bytes, but only " +
                    std::to_string(there) + " follow; copy or export it again");
}

/// Bytes from the begin of a record to field `index`.
std::size_t offset_of(const RecordLayout& layout, std::size_t index) {
    std::size_t sum = 0;
    for (std::size_t i = 0; i < index; ++i) sum += layout.fields[i].size * layout.fields[i].count;
    return sum;
}

/// Reads all records, whose field f of record i lies at `place(f, i)`.
template <class Place>
CloudFile collect(const fs::path& file, const RecordLayout& layout, std::string_view data,
                  const Place& place) {
    const Roles roles = find_roles(file, layout);
    require_bytes(file, layout, data.size());
    CloudFile cloud;
    cloud.has_intensity = roles.intensity.has_value();
    cloud.points->reserve(layout.records);
    const auto number = [&](std::size_t field, std::size_t record) {
        return static_cast<float>(load(file, layout.fields[field],
                                       data.data() + place(field, record), layout.big_endian));
    };
    for (std::size_t i = 0; i < layout.records; ++i)
        append_point(cloud, number(roles.position[0], i), number(roles.position[1], i),
                     number(roles.position[2], i),
                     roles.intensity ? number(*roles.intensity, i) : 0.0F);
    cloud.points->mark_as_modified();
    return cloud;
}

}  // namespace

std::size_t RecordLayout::record_bytes() const {
    return offset_of(*this, fields.size());
}

std::size_t RecordLayout::words() const {
    std::size_t sum = 0;
    for (const Field& field : fields) sum += field.count;
    return sum;
}

CloudFile read_binary_records(const fs::path& file, const RecordLayout& layout,
                              std::string_view data) {
    std::vector<std::size_t> offsets;
    for (std::size_t f = 0; f < layout.fields.size(); ++f) offsets.push_back(offset_of(layout, f));
    const std::size_t each = layout.record_bytes();
    return collect(file, layout, data,
                   [&](std::size_t field, std::size_t i) { return i * each + offsets[field]; });
}

CloudFile read_binary_columns(const fs::path& file, const RecordLayout& layout,
                              std::string_view data) {
    std::vector<std::size_t> offsets;
    for (std::size_t f = 0; f < layout.fields.size(); ++f) offsets.push_back(offset_of(layout, f));
    return collect(file, layout, data, [&](std::size_t field, std::size_t i) {
        return layout.records * offsets[field] +
               i * layout.fields[field].size * layout.fields[field].count;
    });
}

CloudFile read_text_records(const fs::path& file, const RecordLayout& layout, std::string_view text,
                            std::size_t first_line) {
    const Roles roles = find_roles(file, layout);
    CloudFile cloud;
    cloud.has_intensity = roles.intensity.has_value();
    std::vector<std::size_t> word_of;
    std::size_t sum = 0;
    for (const Field& field : layout.fields) {
        word_of.push_back(sum);
        sum += field.count;
    }
    std::size_t line_number = first_line;
    for (; cloud.points->size() < layout.records && !text.empty(); ++line_number) {
        const std::size_t end = std::min(text.find('\n'), text.size());
        const std::vector<std::string_view> words = split_words(text.substr(0, end));
        text.remove_prefix(std::min(end + 1, text.size()));
        if (words.empty()) continue;
        const std::string place = file.string() + ":" + std::to_string(line_number) + ": ";
        if (words.size() != sum)
            throw Error(place + std::to_string(words.size()) + " numbers, but the header names " +
                        std::to_string(sum));
        const auto number = [&](std::size_t field) {
            const std::string_view word = words[word_of[field]];
            const auto value = parse_number(word);
            if (!value) throw Error(place + in_quotes(word) + " is no number");
            return static_cast<float>(*value);
        };
        append_point(cloud, number(roles.position[0]), number(roles.position[1]),
                     number(roles.position[2]), roles.intensity ? number(*roles.intensity) : 0.0F);
    }
    if (cloud.points->size() < layout.records)
        throw Error("cloud file " + file.string() + " is truncated: its header promises " +
                    std::to_string(layout.records) + " points, but only " +
                    std::to_string(cloud.points->size()) + " follow; copy or export it again");
    cloud.points->mark_as_modified();
    return cloud;
}

}  // namespace petal
