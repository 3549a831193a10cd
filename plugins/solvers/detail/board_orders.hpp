// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <functional>
#include <optional>
#include <vector>

#include "petal/calibration/boards.hpp"
#include "petal/calibration/camera_model.hpp"
#include "petal/calibration/correspondences.hpp"
#include "solvers/detail/board_symmetry.hpp"
#include "solvers/detail/reprojection_problem.hpp"

namespace petal {

/// One LiDAR board explained by one image board in one rotation.
struct BoardMatch {
    int lidar = -1;
    int image = -1;
    int rotation = 0;
    bool operator==(const BoardMatch& other) const {
        return lidar == other.lidar && image == other.image && rotation == other.rotation;
    }
};

/// A set of matches (by LiDAR board) with what it leaves.
struct BoardOrder {
    std::vector<BoardMatch> matches;
    std::vector<RefinedPose> poses;  ///< its minima, the best first
    double worst_gate_ratio =
        0.0;  ///< the largest RMS of one board over its gate; within it up to 1
    double rms_px() const { return poses.front().rms_px; }
};

struct GateParams {
    double gate = 0.03;        ///< m on the board
    double min_gate_px = 3.0;  ///< px
};

/// The orders in which the boards of one scene and one camera can belong together.
class BoardOrders {
   public:
    /// Model and LiDAR boards are kept by reference and must outlive this. `poll` is called before
    /// each refinement and may throw, to cancel.
    BoardOrders(const CameraModel& model, const std::vector<LidarBoard>& lidar,
                std::vector<const ImageBoard*> image, GateParams gates,
                std::function<void()> poll = {});

    /// Every distinct order that a hypothesis (one board pair, one rotation, one planar minimum)
    /// leads to, refined; also those that miss their gate. Sorted by RMS.
    std::vector<BoardOrder> search() const;

    /// Pairs of an order, board numbered by match, corners as the image has them.
    std::vector<PointPair> pairs(const std::vector<BoardMatch>& matches) const;
    /// The orders nearest to one: one board rotated, or two boards swapped; refined, without any
    /// gate.
    std::vector<BoardOrder> kin(const BoardOrder& order) const;
    /// The order without its worst boards, down to `count`, refined again. None where that fails.
    std::optional<BoardOrder> reduced(BoardOrder order, std::size_t count) const;

   private:
    std::vector<BoardMatch> explained(const Eigen::Isometry3d& pose) const;
    /// Refines, assigns anew, and so on until the assignment stays; every order on the way is
    /// added.
    void settle(const std::vector<BoardMatch>& matches, const Eigen::Isometry3d& start,
                std::vector<BoardOrder>& found) const;
    /// One entry for each set of matches: a set reached again joins its poses.
    void add(BoardOrder order, std::vector<BoardOrder>& found) const;
    void search_single_boards(std::vector<BoardOrder>& found) const;
    void search_board_pairs(std::vector<BoardOrder>& found) const;
    bool alike(std::size_t lidar, std::size_t image) const;
    /// Where an image board must be if it is that LiDAR board, in the camera's frame; its rotation
    /// does not matter to its centre.
    std::optional<Eigen::Vector3d> centre_seen(std::size_t lidar, std::size_t image) const;
    std::optional<BoardOrder> refined(const std::vector<BoardMatch>& matches,
                                      const std::vector<Eigen::Isometry3d>& starts) const;
    /// RMS of each match over its gate; none where a board is not in front or shows its back.
    std::optional<std::vector<double>> gate_ratios(const std::vector<BoardMatch>& matches,
                                                   const Eigen::Isometry3d& pose) const;
    bool front_seen(const LidarBoard& board, const Eigen::Isometry3d& pose) const;

    const CameraModel& model_;
    const std::vector<LidarBoard>& lidar_;
    std::vector<const ImageBoard*> image_;
    GateParams gates_;
    std::function<void()> poll_;
    std::vector<std::vector<CornerOrder>> rotations_;  ///< of each LiDAR board
};

}  // namespace petal
