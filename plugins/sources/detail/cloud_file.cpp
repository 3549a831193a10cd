// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "sources/detail/cloud_file.hpp"

#include <cctype>
#include <cmath>

#include "petal/error.hpp"
#include "petal/rawlog/input_file.hpp"
#include "sources/detail/text_numbers.hpp"

namespace petal {
namespace {

/// Whether a header word names `letter`: "x", "X", "x_lidar_m", "//X" (as CloudCompare writes), "x
/// (m)".
bool names(const std::string& word, char letter) {
    const std::size_t begin = word.find_first_not_of("/\"");
    if (begin == std::string::npos) return false;
    const std::string text = lower_case(word.substr(begin));
    return text[0] == letter &&
           (text.size() == 1 || std::isalnum(static_cast<unsigned char>(text[1])) == 0);
}

bool names_intensity(const std::string& word) {
    const std::string text = lower_case(word);
    return text == "i" || text.find("intensity") != std::string::npos ||
           text.find("reflect") != std::string::npos;
}

}  // namespace

void append_point(CloudFile& cloud, float x, float y, float z, float intensity) {
    if (!std::isfinite(x) || !std::isfinite(y) || !std::isfinite(z)) ++cloud.not_finite;
    cloud.points->insertPointFast(x, y, z);
    cloud.points->setPointIntensity(cloud.points->size() - 1,
                                    cloud.has_intensity ? intensity : 0.0F);
}

CloudFile read_cloud_text(const std::filesystem::path& file) {
    const TextTable table = read_text_table(file, "cloud file", 3);
    CloudFile cloud;
    cloud.has_intensity = table.columns >= 4;
    if (!table.header.empty()) {
        const auto& words = table.header;
        if (words.size() < 3 || !names(words[0], 'x') || !names(words[1], 'y') ||
            !names(words[2], 'z'))
            throw Error("cloud file " + file.string() + ": its header begins with " +
                        in_quotes(words[0]) +
                        "; the first columns must be x, y and z (then intensity, if any)");
        cloud.has_intensity = table.columns >= 4 && words.size() >= 4 && names_intensity(words[3]);
    }
    const std::size_t used = cloud.has_intensity ? 4 : 3;
    if (table.columns > used)
        cloud.remark = "columns from the " + std::to_string(used + 1) + "th on are left out";
    cloud.points->reserve(table.rows());
    for (std::size_t i = 0; i < table.rows(); ++i)
        append_point(cloud, static_cast<float>(table.at(i, 0)), static_cast<float>(table.at(i, 1)),
                     static_cast<float>(table.at(i, 2)),
                     cloud.has_intensity ? static_cast<float>(table.at(i, 3)) : 0.0F);
    cloud.points->mark_as_modified();
    return cloud;
}

CloudFile read_cloud_file(const std::filesystem::path& file) {
    const std::string ending = lower_case(file.extension().string());
    for (const char* refused : {".las", ".laz", ".bag", ".pcap", ".rawlog", ".jpg", ".png"})
        if (ending == refused)
            throw Error("cloud file " + file.string() + ": " + ending +
                        " is not read as a cloud; convert it to .pcd, .ply or text (x y z)");
    if (ending == ".pcd") return read_pcd(file, read_whole_file(file, "cloud file"));
    if (ending == ".ply") return read_ply(file, read_whole_file(file, "cloud file"));
    return read_cloud_text(file);
}

}  // namespace petal
