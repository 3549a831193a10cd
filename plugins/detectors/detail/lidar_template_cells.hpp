// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "petal/calibration/cloud.hpp"

namespace petal {

/// Three small numbers as one.
/// \pre each in -2^20 to 2^20 - 1
std::uint64_t cell_key(const Eigen::Vector3i& at);

/// The points of a cloud that lie in one cube of a raster.
struct PlateCell {
    Eigen::Vector3f mean = Eigen::Vector3f::Zero();  ///< m, LiDAR frame
    int count = 0;

    void add(const PlateCell& other) {
        count += other.count;
        mean += (other.mean - mean) * (static_cast<float>(other.count) / static_cast<float>(count));
    }
};

/// The cubes with sides of `size` (m) that hold `least` points or more, in the order of their first
/// points. What is not finite, or more than 2^20 cubes away, lies in none. Linear in the points;
/// on the threads of the calling task, and the same for any number of them.
std::vector<PlateCell> gather_cells(const Cloud& cloud, double size, int least);

}  // namespace petal
