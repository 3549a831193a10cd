// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <filesystem>
#include <opencv2/imgcodecs.hpp>
#include <string_view>
#include <vector>

#include "petal/error.hpp"
#include "petal/output.hpp"

namespace petal {

/// A picture in the format of the file's ending. For those who link OpenCV's imgcodecs themselves.
/// \throws Error naming the file.
inline std::vector<unsigned char> picture_bytes(const std::filesystem::path& file,
                                                const cv::Mat& picture) {
    std::vector<unsigned char> bytes;
    if (!cv::imencode(file.extension().string(), picture, bytes))
        throw Error("cannot make the picture " + file.string() +
                    "; OpenCV does not write that kind");
    return bytes;
}

/// Writes what picture_bytes() gave. cv::imwrite() does not see that the last block of a file found
/// no room on the disk. \throws Error naming the file.
inline void write_bytes(const std::filesystem::path& file,
                        const std::vector<unsigned char>& bytes) {
    write_file(file, std::string_view(reinterpret_cast<const char*>(bytes.data()), bytes.size()));
}

/// Both at once.
inline void write_picture(const std::filesystem::path& file, const cv::Mat& picture) {
    write_bytes(file, picture_bytes(file, picture));
}

}  // namespace petal
