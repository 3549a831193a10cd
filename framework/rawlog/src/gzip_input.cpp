// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "petal/rawlog/gzip_input.hpp"

#include <algorithm>

#include "petal/error.hpp"
#include "petal/rawlog/input_file.hpp"

namespace petal {

// Long enough for the class name that begins every object.
constexpr std::size_t kHeadBytes = 160;

GzipInput::GzipInput(const std::filesystem::path& file) : file_(file) {
    require_file(file, "rawlog");
    handle_ = gzopen(file.c_str(), "rb");
    if (handle_ == nullptr) throw Error("rawlog " + file.string() + " cannot be opened");
    gzbuffer(handle_, 1U << 17U);
}

GzipInput::~GzipInput() {
    gzclose_r(handle_);
}

void GzipInput::note_failure(const std::string& otherwise) {
    int code = Z_OK;
    const char* text = gzerror(handle_, &code);
    if (code == Z_BUF_ERROR)
        failure_ = "the compressed data are cut off";
    else if (code == Z_DATA_ERROR)
        failure_ = std::string("the compressed data are damaged (") + text + ")";
    else if (code != Z_OK && code != Z_STREAM_END)
        failure_ = std::string("reading failed (") + text + ")";
    else
        failure_ = otherwise;
}

bool GzipInput::at_end() {
    if (!failure_.empty()) return true;
    const int next = gzgetc(handle_);
    if (next >= 0) {
        gzungetc(next, handle_);
        return false;
    }
    note_failure("");
    return true;
}

void GzipInput::begin_object() {
    object_begin_ = position_;
    head_.clear();
}

size_t GzipInput::Read(void* buffer, size_t count) {
    auto* to = static_cast<char*>(buffer);
    size_t done = 0;
    while (done < count && failure_.empty()) {
        const auto step = static_cast<unsigned>(std::min<size_t>(count - done, 1U << 30U));
        const int got = gzread(handle_, to + done, step);
        if (got > 0) done += static_cast<size_t>(got);
        if (got < static_cast<int>(step)) note_failure("the file ends there");
    }
    position_ += done;
    if (head_.size() < kHeadBytes) head_.append(to, std::min(done, kHeadBytes - head_.size()));
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
