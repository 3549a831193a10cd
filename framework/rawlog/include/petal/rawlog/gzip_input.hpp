// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <mrpt/io/CStream.h>
#include <zlib.h>

#include <cstdint>
#include <filesystem>
#include <string>

namespace petal {

/// A file as MRPT reads it, compressed with gzip or not, that knows where and why reading ended.
/// (MRPT's own stream takes a file that was cut off, or whose checksum is wrong, for one that
/// ends.)
class GzipInput final : public mrpt::io::CStream {
   public:
    /// \throws Error when there is no such file or it cannot be opened.
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

    /// Fills the buffer. Returns fewer bytes only where the file ends, which failure() then tells.
    size_t Read(void* buffer, size_t count) override;
    /// Bytes read so far, uncompressed.
    uint64_t getPosition() const override { return position_; }

    // Not for this stream; they throw.
    size_t Write(const void* buffer, size_t count) override;
    uint64_t Seek(int64_t offset, TSeekOrigin origin) override;
    uint64_t getTotalBytesCount() const override;
    std::string getStreamDescription() const override;

   private:
    void note_failure(const std::string& otherwise);

    std::filesystem::path file_;
    gzFile handle_ = nullptr;
    std::uint64_t position_ = 0;
    std::uint64_t object_begin_ = 0;
    std::string head_;
    std::string failure_;
};

}  // namespace petal
