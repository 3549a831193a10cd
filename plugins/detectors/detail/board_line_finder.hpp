// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstddef>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "detectors/detail/board_line_grid.hpp"
#include "detectors/detail/board_line_pattern.hpp"
#include "detectors/detail/board_line_refine.hpp"
#include "detectors/detail/line_search.hpp"
#include "detectors/detail/line_selection.hpp"
#include "petal/calibration/boards.hpp"
#include "petal/run.hpp"

namespace petal {

struct BoardFinderParams {
    bool use_target_spacing = true;
    double line_threshold = 0.01;
    int min_line_points = 6;
    double min_line_distance = 0.05;
    double edge_tolerance = 0.03;
    double max_inflation = 0.03;
    double edge_asymmetry = 0.0001;
    double edge_range_sigma = 0.0025;
    double min_side_coverage = 0.4;
    double min_sides = 0.75;
    double max_hole_points = 0.1;
    double max_line_rms = 0.012;
    double max_side_offset = 0.008;
};

/// One search for a board among the points of one plane: what was seen and, where it failed, why.
struct BoardAttempt {
    std::vector<Eigen::Vector2d> points;  ///< plane coordinates, m
    std::vector<PlanarLine> lines;        ///< plane coordinates
    std::vector<Eigen::Vector2d>
        corners;                      ///< plane coordinates, of the best placement or the board
    std::optional<LidarBoard> board;  ///< without its target's name
    double closeness = 0.0;           ///< of a failure: the higher the nearer to a board
    std::string miss;                 ///< of a failure: what was found
    std::string threshold;            ///< of a failure: what was needed
};

/// Finds one board in a plane from the lines of its holes' sides; see BoardLines.
class BoardFinder {
   public:
    BoardFinder(const HoleGrid& grid, const BoardFinderParams& params);

    /// Points of the plate of a board at T_lidar_board, off its edges; LiDAR frame. Empty where it
    /// has too few to tell the plane.
    using PlatePoints =
        std::function<std::vector<Eigen::Vector3d>(const Eigen::Isometry3d& T_lidar_board)>;

    /// `points`: LiDAR frame, near the plane; `frame`: T_lidar_plane of plane_frame().
    BoardAttempt find(const std::vector<Eigen::Vector3d>& points, const Eigen::Isometry3d& frame,
                      const PlatePoints& plate_points, Rng& rng,
                      const std::function<void()>& poll) const;

   private:
    void fit_spaced(BoardAttempt& attempt, const std::vector<ScoredPattern>& placements,
                    const std::vector<Eigen::Vector3d>& points, const Eigen::Isometry3d& frame,
                    const PlatePoints& plate_points) const;
    Eigen::Matrix3d unseen_shift(const Eigen::Isometry3d& T_lidar_board, bool has_plate) const;
    void fit_plain(BoardAttempt& attempt, const std::vector<ScoredPattern>& placements,
                   const LineSplit& split, const Eigen::Isometry3d& frame) const;
    bool intersect(BoardAttempt& attempt, const LineFamily& vertical, const LineFamily& horizontal,
                   const Eigen::Isometry3d& frame) const;
    /// False, with the reason in `attempt`, where the score is no board's.
    bool accept(BoardAttempt& attempt, const PatternScore& score,
                const Eigen::Vector2d& inflation) const;
    std::map<std::string, double> quality(const PatternScore& score,
                                          const BoardAttempt& attempt) const;

    const HoleGrid& grid_;
    BoardFinderParams params_;
};

}  // namespace petal
