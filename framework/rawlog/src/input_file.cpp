// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "petal/rawlog/input_file.hpp"

#include <fstream>
#include <system_error>

#include "petal/error.hpp"

namespace petal {

namespace fs = std::filesystem;

void require_file(const fs::path& file, const std::string& what) {
    std::error_code error;
    const fs::file_status status = fs::status(file, error);
    if (!fs::exists(status))
        throw Error(what + " " + file.string() + " does not exist; check the path" +
                    (file.is_relative() ? " (it is relative to " + fs::current_path().string() + ")"
                                        : std::string()));
    if (fs::is_directory(status))
        throw Error(what + " " + file.string() + " is a folder; name a file in it");
    // A pipe would block here, and cannot be read twice (its checksum goes into run.json).
    if (!fs::is_regular_file(status))
        throw Error(what + " " + file.string() + " is a pipe or a device; name a regular file");
    if (!std::ifstream(file, std::ios::binary))
        throw Error(what + " " + file.string() + " cannot be opened; check its permissions");
}

std::string read_whole_file(const fs::path& file, const std::string& what) {
    require_file(file, what);
    std::ifstream stream(file, std::ios::binary);
    std::string bytes((std::istreambuf_iterator<char>(stream)), std::istreambuf_iterator<char>());
    if (stream.bad()) throw Error(what + " " + file.string() + ": reading it failed half-way");
    return bytes;
}

}  // namespace petal
