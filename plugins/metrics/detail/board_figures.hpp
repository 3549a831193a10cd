// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <string>
#include <vector>

#include "metrics/detail/board_errors.hpp"
#include "petal/calibration/metrics.hpp"

namespace petal {

/// What became of the boards of a scene, or of all.
struct BoardCounts {
    int found = 0, missed = 0, spurious = 0;
    void add(const BoardCounts& other);
};

/// Figures of one board, `prefix` "board_truth.board_1.lidar_".
std::vector<Metric> lidar_figures(const LidarBoardError& error, const std::string& prefix,
                                  const std::string& scene);
std::vector<Metric> image_figures(const ImageBoardError& error, const std::string& prefix,
                                  const std::string& scene);

/// RMS errors over boards, RMS of the errors in sigmas, mean NEES over its degrees of freedom;
/// `prefix` "board_truth.lidar_".
std::vector<Metric> lidar_summary(const std::vector<LidarBoardError>& errors,
                                  const BoardCounts& counts, const std::string& prefix);
std::vector<Metric> image_summary(const std::vector<ImageBoardError>& errors,
                                  const BoardCounts& counts, const std::string& prefix);

/// found, missed, false.
std::vector<Metric> count_figures(const BoardCounts& counts, const std::string& prefix,
                                  const std::string& scene);

}  // namespace petal
