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

/// Writes a picture, in the format of the file's ending. cv::imwrite() does not see that the last
/// block of a file found no room on the disk. For those who link OpenCV's imgcodecs themselves.
/// \throws Error naming the file.
inline void write_picture(const std::filesystem::path& file, const cv::Mat& picture) {
    std::vector<unsigned char> bytes;
    if (!cv::imencode(file.extension().string(), picture, bytes))
        throw Error("cannot make the picture " + file.string() +
                    "; OpenCV does not write that kind");
    write_file(file, std::string_view(reinterpret_cast<const char*>(bytes.data()), bytes.size()));
}

}  // namespace petal
