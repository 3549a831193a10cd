// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "petal/calibration/metrics.hpp"

namespace petal {

/// A pair's reprojection error: measured minus projected (px), its range from the LiDAR (m), and
/// whether it is a corner of a board.
struct PairError {
    Eigen::Vector2d error_px = Eigen::Vector2d::Zero();
    double range = 0.0;
    bool of_board = false;
};

/// The largest range of all pairs (m); 0 where there are none.
double largest_range(const std::vector<PairError>& errors);

/// The normalised errors of ACSC (Cui et al., reference 25 of the letter): |du| and |dv| of each
/// pair (px), times its range over the largest range of all; zero where all pairs are at range 0.
std::vector<Eigen::Vector2d> normalised_errors(const std::vector<PairError>& errors);

/// Their mean over all 2N values (px). NaN for no pairs.
double normalised_mean(const std::vector<PairError>& errors);

/// The figures of `metric.reprojection` over some pairs (none: only the count), for one scene or
/// (empty name) in total.
std::vector<Metric> error_figures(const std::vector<PairError>& errors, const std::string& scene);

}  // namespace petal
