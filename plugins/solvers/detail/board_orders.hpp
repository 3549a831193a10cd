// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <functional>
#include <optional>
#include <vector>

#include "solvers/detail/board_set.hpp"
#include "solvers/detail/reprojection_problem.hpp"

namespace petal {

/// A set of matches (by LiDAR board) over all scenes with what it leaves.
struct BoardOrder {
    std::vector<BoardMatch> matches;
    std::vector<RefinedPose> poses;  ///< its minima, the best first
    double worst_gate_ratio =
        0.0;                      ///< the largest RMS of one board over its gate; within it up to 1
    std::size_t within_gate = 0;  ///< how many boards are
    double rms_px() const { return poses.front().rms_px; }
};

/// The orders in which the boards that a LiDAR and a camera see can belong together.
class BoardOrders {
   public:
    /// `boards` must outlive this. `poll` is called before each refinement and may throw, to
    /// cancel.
    explicit BoardOrders(const BoardSet& boards, std::function<void()> poll = {});

    /// Every distinct order that a hypothesis leads to, refined over all scenes together; also
    /// those that miss their gate. Those with the most boards within it come first, then the
    /// least RMS.
    std::vector<BoardOrder> search() const;

    /// The orders nearest to one: all boards rolled with one, one board rotated, two boards
    /// swapped; refined, without any gate.
    std::vector<BoardOrder> kin(const BoardOrder& order) const;
    /// The order without its worst boards, down to `count`, refined again. None where that fails.
    std::optional<BoardOrder> reduced(BoardOrder order, std::size_t count) const;

    const BoardSet& boards() const { return boards_; }

   private:
    std::optional<BoardOrder> refined(const std::vector<BoardMatch>& matches,
                                      const std::vector<Eigen::Isometry3d>& starts) const;
    /// Refines, assigns anew, and so on until the assignment stays; every order on the way is
    /// added.
    void settle(const std::vector<BoardMatch>& matches, const Eigen::Isometry3d& start,
                std::vector<BoardOrder>& found) const;
    /// One entry for each set of matches: a set reached again joins its poses.
    void add(BoardOrder order, std::vector<BoardOrder>& found) const;
    /// Puts in order what the best pose says of the gates; false where it says nothing.
    bool weigh(BoardOrder& order) const;

    const BoardSet& boards_;
    std::function<void()> poll_;
};

}  // namespace petal
