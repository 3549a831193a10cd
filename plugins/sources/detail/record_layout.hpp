// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "sources/detail/cloud_file.hpp"

namespace petal {

/// How the points of a PCD or PLY file lie there: the fields of one record, in their order.
struct RecordLayout {
    struct Field {
        std::string name;
        char kind = 'F';       ///< F floating point, I signed, U unsigned
        std::size_t size = 4;  ///< bytes of one element
        std::size_t count = 1;
    };
    std::vector<Field> fields;
    std::size_t records = 0;
    bool big_endian = false;

    /// Bytes of one binary record.
    /// \throws Error, naming the file, when that or the file's size overflows.
    std::size_t record_bytes() const;
    std::size_t words() const;  ///< numbers of one text record
};

/// Reads records of little or big endian numbers. `data` begins with the first.
/// \throws Error: no x, y, z; a field of unknown kind; fewer bytes than the header promises (both
/// are told).
CloudFile read_binary_records(const std::filesystem::path& file, const RecordLayout& layout,
                              std::string_view data);

/// The same for records that lie field by field, as in a binary_compressed PCD.
CloudFile read_binary_columns(const std::filesystem::path& file, const RecordLayout& layout,
                              std::string_view data);

/// The same from text, a record a line; `first_line` is the number of its first line in the file.
CloudFile read_text_records(const std::filesystem::path& file, const RecordLayout& layout,
                            std::string_view text, std::size_t first_line);

}  // namespace petal
