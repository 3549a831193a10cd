// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <mrpt/maps/CPointsMapXYZI.h>

#include <cstddef>
#include <filesystem>
#include <memory>
#include <string>

namespace petal {

/// The points of a cloud file, and what is worth telling of them.
struct CloudFile {
    std::shared_ptr<mrpt::maps::CPointsMapXYZI> points =
        std::make_shared<mrpt::maps::CPointsMapXYZI>();
    bool has_intensity = false;
    std::size_t not_finite = 0;  ///< points with a NaN or an infinity in x, y or z; they are kept
    std::string remark;          ///< what was left out, e.g. further columns; may be empty
};

/// Reads a cloud by its ending: .pcd (ascii, binary, binary_compressed), .ply (ascii, binary),
/// anything else as text (x y z [intensity]). Metres are assumed. A file without points is an
/// empty cloud.
/// \throws Error naming the file and the place: no such file, wrong header, truncated, no
/// numbers.
CloudFile read_cloud_file(const std::filesystem::path& file);

// The three formats; `bytes` is the whole file.
CloudFile read_cloud_text(const std::filesystem::path& file);
CloudFile read_pcd(const std::filesystem::path& file, const std::string& bytes);
CloudFile read_ply(const std::filesystem::path& file, const std::string& bytes);

/// Appends a point; `intensity` is ignored where the cloud has none.
void append_point(CloudFile& cloud, float x, float y, float z, float intensity);

}  // namespace petal
