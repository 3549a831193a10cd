// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <filesystem>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "petal/calibration/target.hpp"
#include "petal/calibration/truth.hpp"
#include "petal/run.hpp"

namespace petal {

/// Finds targets by the name that a truth tells: among given files, else those that petal ships.
class TargetsByName {
   public:
    explicit TargetsByName(std::vector<std::filesystem::path> files) : files_(std::move(files)) {}
    /// Reads each file once, and tells `run` of it. \throws Error where there is none of that name.
    const Target& find(const std::string& name, Run& run);

   private:
    std::vector<std::filesystem::path> files_;
    bool files_read_ = false;
    std::map<std::string, Target> known_;
};

/// The boards of a scene: how far a point lies from their edges.
class BoardEdges {
   public:
    /// \throws Error where a target is not known.
    BoardEdges(const std::vector<Truth::Board>& boards, TargetsByName& targets, Run& run);

    bool empty() const { return boards_.empty(); }
    /// The distance (m), in the plane of the board nearest to the point (LiDAR frame), to the
    /// nearest side of its outline or of a hole. Infinity where there is no board, or for a point
    /// with NaN.
    double distance(const Eigen::Vector3d& point) const;

    /// Where a point lies on the board nearest to it.
    struct Place {
        int board = -1;     ///< -1: there is no board, or the point has NaN
        double away = 0.0;  ///< m, from the plate; 0 on it and in its holes' place in its plane
        double edge = 0.0;  ///< m, in the board's plane, to the nearest side of outline or hole
    };
    Place place(const Eigen::Vector3d& point) const;

    /// The side of a polygonal hole of that board nearest to a point, in the board's plane; sides
    /// are counted over the holes. -1 where there is none.
    struct HoleSide {
        int side = -1;
        double distance = 0.0;  ///< m
    };
    HoleSide nearest_hole_side(int board, const Eigen::Vector3d& point) const;
    /// Sides of polygonal holes of a board.
    int hole_sides(int board) const;
    std::size_t size() const { return boards_.size(); }

   private:
    struct Board {
        Target target;
        Eigen::Isometry3d T_board_lidar;
    };
    std::vector<Board> boards_;
};

}  // namespace petal
