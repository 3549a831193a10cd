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

/// Forces a file, or a folder's entries, to disk: a rename must not become visible before the
/// content.
void sync(const fs::path& path, int flags) {
    const int descriptor = ::open(path.c_str(), flags | O_CLOEXEC);
    if (descriptor < 0)
        throw Error("cannot write " + path.string() + ": " + reason(errno) +
                    "; check that the folder is writable");
    const int failed = ::fsync(descriptor) != 0 ? errno : 0;
    ::close(descriptor);
    // Some file systems cannot sync a folder and say so: that is no loss of content.
    if (failed != 0 && failed != EINVAL && failed != EROFS)
        throw Error("cannot write " + path.string() + ": " + reason(failed) +
                    "; is the disk full?");
}

}  // namespace

void write_file(const fs::path& path, std::string_view content) {
    errno = 0;
    std::ofstream file(path, std::ios::binary | std::ios::trunc);
    if (!file)
        throw Error("cannot write " + path.string() + ": " + reason(errno) +
                    "; check that the folder is writable");
    file.write(content.data(), static_cast<std::streamsize>(content.size()));
    file.close();
    if (!file)
        throw Error("cannot write " + path.string() + ": " + reason(errno) + "; is the disk full?");
}

PendingFile::PendingFile(fs::path final_path) : final_(std::move(final_path)) {
    const fs::path folder = final_.has_parent_path() ? final_.parent_path() : fs::path(".");
    std::error_code error;
    fs::create_directories(folder, error);
    if (error)
        throw Error("cannot make the folder " + folder.string() + ": " + error.message() +
                    "; give another one with --out");
    if (::access(folder.c_str(), W_OK | X_OK) != 0)
        throw Error("cannot write into the folder " + folder.string() + ": " + reason(errno) +
                    "; give another one with --out");
    temporary_ = folder / ("." + final_.stem().string() + ".part" + final_.extension().string());
}

PendingFile::~PendingFile() {
    if (committed_) return;
    std::error_code ignored;  // nothing may have been written yet
    fs::remove(temporary_, ignored);
}

void PendingFile::commit() {
    std::error_code error;
    if (!fs::exists(temporary_, error))
        throw Error("nothing was written for " + final_.string() + "; is the disk full?");
    sync(temporary_, O_RDONLY);
    fs::rename(temporary_, final_, error);
    if (error) throw Error("cannot put " + final_.string() + " in place: " + error.message());
    committed_ = true;
    sync(final_.has_parent_path() ? final_.parent_path() : fs::path("."), O_RDONLY | O_DIRECTORY);
}

}  // namespace petal
