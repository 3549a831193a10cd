// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <mrpt/io/CStream.h>
#include <zlib.h>

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "petal/rawlog/claim_check.hpp"

namespace petal {

/// A file as MRPT reads it, compressed with gzip (one member or several) or not, that knows where
/// and why reading ended. (MRPT's own stream, as zlib's gzread, takes a file that was cut off,
/// whose checksum is wrong, or that something else follows, for one that ends.)
class GzipInput final : public mrpt::io::CStream {
   public:
    /// \throws Error when there is no such file, it is no regular file, or it cannot be opened.
    explicit GzipInput(const std::filesystem::path& file);
    ~GzipInput() override;
    GzipInput(const GzipInput&) = delete;
    GzipInput& operator=(const GzipInput&) = delete;

    /// True when nothing follows: at a sound end, or at damage, which failure() tells.
    bool at_end();
    /// Why reading ended early, in plain words; empty while all is well.
    const std::string& failure() const { return failure_; }

    /// Marks the begin of an object: head() then has its first bytes.
    void begin_object();
    std::uint64_t object_begin() const { return object_begin_; }
    const std::string& head() const { return head_; }

    bool compressed() const { return compressed_; }
    std::uint64_t file_size() const { return file_size_; }  ///< bytes as it lies on the disk
    std::uint64_t file_position() const { return taken_; }  ///< of these, read so far
    /// No more bytes than these can follow: exact for a plain file; for a compressed one what
    /// deflate could make of the rest of it at its very best (1032 to 1).
    std::uint64_t can_follow() const;

    /// Fills the buffer. Returns fewer bytes only where the file ends, which failure() then tells.
    /// \throws Error, once an object has begun, where bytes are missing, and where they are a count
    /// that cannot be true, as failure() tells too: MRPT would go on with what it has.
    size_t Read(void* buffer, size_t count) override;
    /// Bytes read so far, uncompressed.
    uint64_t getPosition() const override { return position_; }

    // Not for this stream; they throw.
    size_t Write(const void* buffer, size_t count) override;
    uint64_t Seek(int64_t offset, TSeekOrigin origin) override;
    uint64_t getTotalBytesCount() const override;
    std::string getStreamDescription() const override;

   private:
    /// Reads more of the file where none is left. False at its end, or where reading failed.
    bool have_input();
    /// Up to `count` uncompressed bytes. 0 at the end, sound or not.
    size_t produce(unsigned char* to, size_t count);
    size_t produce_inflated(unsigned char* to, size_t count);
    void begin_member();

    std::filesystem::path file_;
    int descriptor_ = -1;
    std::uint64_t file_size_ = 0;
    std::uint64_t taken_ = 0;  ///< bytes of the file that were read from the disk
    bool compressed_ = false;
    bool in_member_ = false;  ///< between a gzip header and its trailer
    bool inflating_ = false;  ///< inflater_ is set up
    z_stream inflater_ = {};
    std::vector<unsigned char> input_;   ///< as on the disk; inflater_ points into it
    std::vector<unsigned char> output_;  ///< uncompressed, for the many small reads
    std::size_t next_ = 0;               ///< in output_: [next_, end_) is not read yet
    std::size_t end_ = 0;
    std::uint64_t position_ = 0;
    std::uint64_t object_begin_ = 0;
    std::string head_;
    bool in_object_ = false;
    ClaimCheck claims_;
    std::string failure_;
};

}  // namespace petal
