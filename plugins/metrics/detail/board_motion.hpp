// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "petal/calibration/boards.hpp"
#include "petal/calibration/cloud.hpp"
#include "petal/calibration/se3.hpp"
#include "petal/calibration/target.hpp"
#include "petal/run.hpp"

namespace petal {

/// A capture cut into equal parts by time.
struct TimeSplits {
    double length = 0.0;              ///< s, of each
    std::vector<std::size_t> begins;  ///< index of the first point of each; one more: the end

    std::size_t size() const { return begins.empty() ? 0 : begins.size() - 1; }
};

/// Splits of at least `shortest` s, at most `most` of them, by the stamps of the LiDAR's messages.
/// None where the messages have no times, stand in no order, or last less than two splits; `why`
/// then tells in words.
TimeSplits time_splits(const Cloud& cloud, double shortest, std::size_t most, std::string& why);

/// Where a board was in one split, against the whole capture: along and about the board's own axes
/// at its middle; x right, y down, z into the board (m), then the rotations about them (rad).
struct SplitPose {
    Vector6d value = Vector6d::Zero();
    Matrix6d covariance = Matrix6d::Zero();
    bool sideways = false;  ///< x, y and the roll are known too
};

/// One a split; none where it holds too few points of the board. \throws Cancelled
std::vector<std::optional<SplitPose>> split_poses(const Run& run, const Cloud& cloud,
                                                  const TimeSplits& splits, const LidarBoard& board,
                                                  const Target& target);

/// The largest motion between two splits.
struct BoardMotion {
    double length = 0.0;  ///< m, of that of the board's middle or of a corner, whichever is larger
    double sigma = 0.0;   ///< m, along it
    std::size_t from = 0, to = 0;  ///< splits
    bool moved = false;            ///< more than chance, and more than the limit
    /// The longest run of splits, each with a pose, without motion among them: first, and one
    /// behind the last.
    std::size_t still_begin = 0, still_end = 0;
};

/// What counts as motion: a number of the 6 of a pair of splits, as metres at the board's rim,
/// larger than `least` and than `sigmas` of its own sigma. The bound on sigmas is raised with the
/// number of comparisons, so that a still board is seldom taken for one that moves, however many
/// splits there are. None for fewer than two splits with a pose.
std::optional<BoardMotion> board_motion(const std::vector<std::optional<SplitPose>>& poses,
                                        double half_width, double half_height, double sigmas,
                                        double least);

}  // namespace petal
