// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

namespace petal {

/// Follows what MRPT reads of an object, and tells a count that cannot be true.
///
/// MRPT makes room for what a count claims before it reads it: one damaged byte may ask for 64 GB.
/// The places where the large counts stand are known here for the classes that petal works with
/// (points, ranges, images, labels), by the sizes of the reads since the last class header. A
/// class, or a version of it, that is not known here is not checked, and never refused.
class ClaimCheck {
   public:
    void begin_object();
    /// Told of each read of the object in work. \param can_follow bytes that can still come.
    /// \returns what is wrong, in plain words; empty where nothing is.
    std::string after_read(const void* bytes, std::size_t count, std::uint64_t can_follow);

   private:
    bool is_header(const void* bytes, std::size_t count);
    /// Whether a read of so many bytes is that of a picture in JPEG, by the reads before it.
    bool is_jpeg(std::size_t count) const;

    std::string outer_;            ///< class of the object; in a frame or collection, of its part
    std::string last_;             ///< class of the last header, without its namespace
    std::string reads_;            ///< a token for each read since that header
    std::string problem_;          ///< of a header
    std::size_t name_length_ = 0;  ///< of a class name that may come next
    std::size_t old_length_ = 0;   ///< the same, of the old format
    bool version_next_ = false;
    int outer_version_ = 0;
    int last_version_ = 0;
    std::uint32_t value_ = 0;     ///< of the last read of 2 or 4 bytes
    std::uint32_t previous_ = 0;  ///< of that before it
};

}  // namespace petal
