// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <filesystem>
#include <string_view>

namespace petal {

/// Writes `content` to `path`, replacing what is there. For the path that Run::save and Run::output
/// hand out. \throws WriteError naming the file (by the name that it gets in the end) when it
/// cannot be opened, or the disk is full.
void write_file(const std::filesystem::path& path, std::string_view content);

/// A file that appears whole or not at all. It is written under a temporary name in the same folder
/// (`scene.rawlog` as `.scene.part.rawlog`, so that writers which look at the extension still
/// work); commit() flushes it to disk and renames it. Without commit() the destructor removes it.
class PendingFile {
   public:
    /// Makes the parent folders. \throws WriteError, naming the folder, when it cannot be written
    /// to.
    explicit PendingFile(std::filesystem::path final_path);
    PendingFile(const PendingFile&) = delete;
    PendingFile& operator=(const PendingFile&) = delete;
    ~PendingFile();

    /// The name under which it is written until commit().
    static std::filesystem::path temporary_of(const std::filesystem::path& final_path);

    const std::filesystem::path& path() const { return temporary_; }
    const std::filesystem::path& final_path() const { return final_; }
    /// \throws WriteError when the file was not written, or the disk is full.
    void commit();

   private:
    std::filesystem::path final_;
    std::filesystem::path temporary_;
    bool committed_ = false;
};

}  // namespace petal
