// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "text_file.hpp"

#include <array>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <system_error>

namespace petal {

std::optional<std::string> read_text_file(const std::filesystem::path& file, std::string& why) {
    std::error_code error;
    const auto status = std::filesystem::status(file, error);
    if (!std::filesystem::exists(status)) {
        const bool absent = status.type() == std::filesystem::file_type::not_found;
        why = absent ? "no such file; expected a JSON file"
                     : "cannot be reached (" + error.message() + "); expected a readable JSON file";
        return std::nullopt;
    }
    if (std::filesystem::is_directory(status)) {
        why = "is a folder; expected a JSON file";
        return std::nullopt;
    }
    errno = 0;
    std::ifstream stream(file, std::ios::binary);
    if (!stream) {
        why = std::string("cannot be opened (") + std::strerror(errno) +
              "); expected a readable JSON file";
        return std::nullopt;
    }
    // Read in pieces: a pipe has no size, and a device may have no end.
    std::string text;
    std::array<char, 65536> piece{};
    while (stream.read(piece.data(), piece.size()) || stream.gcount() > 0) {
        text.append(piece.data(), static_cast<std::size_t>(stream.gcount()));
        if (text.size() > kLargestPipelineFile) {
            why = "is larger than " + std::to_string(kLargestPipelineFile >> 20U) +
                  " MiB; expected a pipeline or a patch";
            return std::nullopt;
        }
    }
    if (stream.bad()) {
        why = "could not be read to its end; expected a readable JSON file";
        return std::nullopt;
    }
    return text;
}

}  // namespace petal
