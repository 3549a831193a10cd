// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "petal/output.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <fstream>
#include <string>
#include <system_error>
#include <utility>

#include "petal/error.hpp"

namespace petal {

namespace fs = std::filesystem;

namespace {

std::string reason(int error_number) {
    return std::generic_category().message(error_number);
}

constexpr char kPart[] = ".part";
constexpr char kFull[] = "; is the disk full? Free some space, or give another folder with --out";

/// What a file is called in a message: a temporary one by the name that it gets in the end.
std::string shown(const fs::path& path) {
    const std::string stem = path.stem().string();
    const std::size_t part = sizeof(kPart) - 1;
    const bool temporary = stem.size() > part + 1 && stem[0] == '.' &&
                           stem.compare(stem.size() - part, part, kPart) == 0;
    if (!temporary) return path.string();
    const std::string name = stem.substr(1, stem.size() - 1 - part) + path.extension().string();
    return (path.parent_path() / name).string();
}

/// Forces a file, or a folder's entries, to disk: a rename must not become visible before the
/// content.
void sync(const fs::path& path, int flags) {
    const int descriptor = ::open(path.c_str(), flags | O_CLOEXEC);
    if (descriptor < 0)
        throw WriteError("cannot write " + shown(path) + ": " + reason(errno) +
                         "; check that the folder is writable");
    const int failed = ::fsync(descriptor) != 0 ? errno : 0;
    ::close(descriptor);
    // Some file systems cannot sync a folder and say so: that is no loss of content.
    if (failed != 0 && failed != EINVAL && failed != EROFS)
        throw WriteError("cannot write " + shown(path) + ": " + reason(failed) + kFull);
}

}  // namespace

void write_file(const fs::path& path, std::string_view content) {
    errno = 0;
    std::ofstream file(path, std::ios::binary | std::ios::trunc);
    if (!file && errno == ENOSPC)
        throw WriteError("cannot write " + shown(path) + ": " + reason(errno) + kFull);
    if (!file)
        throw WriteError("cannot write " + shown(path) + ": " + reason(errno) +
                         "; check that the folder is writable");
    file.write(content.data(), static_cast<std::streamsize>(content.size()));
    file.close();
    if (!file) throw WriteError("cannot write " + shown(path) + ": " + reason(errno) + kFull);
}

PendingFile::PendingFile(fs::path final_path) : final_(std::move(final_path)) {
    const fs::path folder = final_.has_parent_path() ? final_.parent_path() : fs::path(".");
    std::error_code error;
    fs::create_directories(folder, error);
    if (error)
        throw WriteError("cannot make the folder " + folder.string() + ": " + error.message() +
                         "; give another one with --out");
    if (::access(folder.c_str(), W_OK | X_OK) != 0)
        throw WriteError("cannot write into the folder " + folder.string() + ": " + reason(errno) +
                         "; give another one with --out");
    temporary_ = temporary_of(final_);
}

fs::path PendingFile::temporary_of(const fs::path& final_path) {
    const fs::path folder = final_path.has_parent_path() ? final_path.parent_path() : fs::path(".");
    return folder / ("." + final_path.stem().string() + kPart + final_path.extension().string());
}

PendingFile::~PendingFile() {
    if (committed_) return;
    std::error_code ignored;  // nothing may have been written yet
    fs::remove(temporary_, ignored);
}

void PendingFile::commit() {
    std::error_code error;
    if (!fs::exists(temporary_, error))
        throw WriteError("nothing was written for " + final_.string() + kFull);
    sync(temporary_, O_RDONLY);
    fs::rename(temporary_, final_, error);
    if (error) throw WriteError("cannot put " + final_.string() + " in place: " + error.message());
    committed_ = true;
    sync(final_.has_parent_path() ? final_.parent_path() : fs::path("."), O_RDONLY | O_DIRECTORY);
}

}  // namespace petal
