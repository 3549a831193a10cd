// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "petal/rawlog/gzip_input.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include "petal/error.hpp"
#include "petal/rawlog/input_file.hpp"

namespace petal {
namespace {

// Long enough for the class name that begins every object.
constexpr std::size_t kHeadBytes = 160;
constexpr std::size_t kBufferBytes = std::size_t{1} << 17U;
// A deflate symbol is a bit at least and makes 258 bytes at most; zlib's own figure.
constexpr std::uint64_t kBestRatio = 1032;
// The window of 15 bits that gzip has, with gzip's header and trailer.
constexpr int kGzipWindow = 15 + 16;

std::string plain_reason(const char* message) {
    const std::string text = message == nullptr ? "" : message;
    if (text == "incorrect data check") return "the checksum is not that of the data";
    if (text == "incorrect length check") return "the length is not that of the data";
    return text.empty() ? "unknown error" : text;
}

}  // namespace

GzipInput::GzipInput(const std::filesystem::path& file)
    : file_(file), input_(kBufferBytes), output_(kBufferBytes) {
    require_file(file, "rawlog");
    descriptor_ = ::open(file.c_str(), O_RDONLY | O_CLOEXEC);  // NOLINT: a C function
    if (descriptor_ < 0)
        throw Error("rawlog " + file.string() + " cannot be opened (" + std::strerror(errno) + ")");
    struct stat status = {};
    if (::fstat(descriptor_, &status) == 0) file_size_ = static_cast<std::uint64_t>(status.st_size);
    compressed_ = have_input() && inflater_.avail_in >= 2 && inflater_.next_in[0] == 0x1F &&
                  inflater_.next_in[1] == 0x8B;
    if (compressed_) begin_member();
}

GzipInput::~GzipInput() {
    if (inflating_) inflateEnd(&inflater_);
    if (descriptor_ >= 0) ::close(descriptor_);
}

std::uint64_t GzipInput::can_follow() const {
    const std::uint64_t on_disk =
        (file_size_ > taken_ ? file_size_ - taken_ : 0) + inflater_.avail_in;
    // Inside the inflater wait, at most, the match in work and the bits of one byte.
    return (end_ - next_) + (compressed_ ? (on_disk + 1) * kBestRatio : on_disk);
}

bool GzipInput::have_input() {
    if (inflater_.avail_in > 0) return true;
    if (!failure_.empty()) return false;
    ssize_t got = 0;
    do {
        got = ::read(descriptor_, input_.data(), input_.size());
    } while (got < 0 && errno == EINTR);
    if (got < 0) failure_ = std::string("reading failed (") + std::strerror(errno) + ")";
    if (got <= 0) return false;
    taken_ += static_cast<std::uint64_t>(got);
    inflater_.next_in = input_.data();
    inflater_.avail_in = static_cast<unsigned>(got);
    return true;
}

void GzipInput::begin_member() {
    const int code = inflating_ ? inflateReset(&inflater_) : inflateInit2(&inflater_, kGzipWindow);
    if (code != Z_OK) throw Error("rawlog " + file_.string() + ": zlib cannot be set up");
    inflating_ = in_member_ = true;
}

size_t GzipInput::produce_inflated(unsigned char* to, size_t count) {
    const auto wanted = static_cast<unsigned>(std::min<size_t>(count, std::size_t{1} << 30U));
    inflater_.next_out = to;
    inflater_.avail_out = wanted;
    while (inflater_.avail_out == wanted) {
        const bool more = have_input();
        if (!in_member_) {
            if (!more) return 0;  // the sound end, or reading failed
            if (*inflater_.next_in != 0x1F) {
                failure_ = "what follows the compressed data is not compressed";
                return 0;
            }
            begin_member();
        }
        if (!more) {
            if (failure_.empty()) failure_ = "the compressed data are cut off";
            return 0;
        }
        const int code = inflate(&inflater_, Z_NO_FLUSH);
        if (code == Z_STREAM_END) {
            in_member_ = false;
        } else if (code != Z_OK && code != Z_BUF_ERROR) {
            failure_ =
                "the compressed data are damaged (" +
                (code == Z_MEM_ERROR ? std::string("out of memory") : plain_reason(inflater_.msg)) +
                ")";
            break;  // what came out before is still handed on
        }
    }
    return wanted - inflater_.avail_out;
}

size_t GzipInput::produce(unsigned char* to, size_t count) {
    if (!failure_.empty()) return 0;
    if (compressed_) return produce_inflated(to, count);
    if (!have_input()) return 0;
    const std::size_t step = std::min<std::size_t>(count, inflater_.avail_in);
    std::memcpy(to, inflater_.next_in, step);
    inflater_.next_in += step;
    inflater_.avail_in -= static_cast<unsigned>(step);
    return step;
}

bool GzipInput::at_end() {
    if (next_ < end_) return false;
    next_ = 0;
    end_ = produce(output_.data(), output_.size());
    return end_ == 0;
}

void GzipInput::begin_object() {
    object_begin_ = position_;
    head_.clear();
    claims_.begin_object();
    in_object_ = true;
}

size_t GzipInput::Read(void* buffer, size_t count) {
    auto* to = static_cast<unsigned char*>(buffer);
    size_t done = 0;
    while (done < count) {
        size_t got = std::min(count - done, end_ - next_);
        if (got > 0) {
            std::memcpy(to + done, output_.data() + next_, got);
            next_ += got;
        } else if (count - done >= output_.size()) {
            got = produce(to + done, count - done);
            if (got == 0) break;
        } else if (at_end()) {
            break;
        }
        done += got;
    }
    if (done < count && failure_.empty()) failure_ = "the file ends there";
    position_ += done;
    if (head_.size() < kHeadBytes)
        head_.append(static_cast<const char*>(buffer), std::min(done, kHeadBytes - head_.size()));
    if (!in_object_) return done;
    // MRPT goes on with what stood in memory before where a number is read in part only.
    if (done < count) throw Error(failure_);
    if (count > 0) {
        const std::string wrong = claims_.after_read(buffer, count, can_follow());
        if (!wrong.empty()) {
            if (failure_.empty()) failure_ = wrong;
            throw Error(wrong);
        }
    }
    return done;
}

size_t GzipInput::Write(const void*, size_t) {
    throw Error("rawlog " + file_.string() + " is open for reading");
}

uint64_t GzipInput::Seek(int64_t, TSeekOrigin) {
    throw Error("rawlog " + file_.string() + " is read as a stream");
}

uint64_t GzipInput::getTotalBytesCount() const {
    throw Error("rawlog " + file_.string() + " is read as a stream");
}

std::string GzipInput::getStreamDescription() const {
    return file_.string();
}

}  // namespace petal
