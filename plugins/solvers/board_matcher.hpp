// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <vector>

#include "petal/calibration/boards.hpp"
#include "petal/calibration/correspondences.hpp"
#include "petal/run.hpp"
#include "petal/spec.hpp"
#include "petal/stage.hpp"
#include "solvers/detail/order_choice.hpp"

namespace petal {

struct BoardMatcherParams : OrderParams, GateParams {
    BoardMatcherParams() {}  // not an aggregate: GCC 12 warns of one with such bases
    bool use_distortion = true;
    double lidar_sigma = 0.005;
    int max_image_boards = 12;
};

/// `solver.board_matcher`: which LiDAR board is which image board, in which rotation.
class BoardMatcher final : public Stage {
   public:
    using Params = BoardMatcherParams;
    static void describe(Spec<Params>& s);
    explicit BoardMatcher(Params params) : p_(params) {}
    void run(Run& run) override;

   private:
    CameraPairs match(Run& run, const LidarBoards& lidar, const ImageBoards& image,
                      const CameraInfo& camera) const;
    /// Adds what the LiDAR's noise makes in the image to each pair's covariance.
    void add_lidar_noise(const CameraModel& model, const std::vector<LidarBoard>& boards,
                         const OrderChoice& choice, std::vector<PointPair>& pairs) const;

    /// Of more image boards than may be tried the largest ones, in their order; a note tells.
    void keep_largest(Run& run, const std::string& camera, std::vector<const ImageBoard*>& seen,
                      std::vector<int>& index) const;
    /// What the data decided is taken back where it leaves more than noise: then a board is false,
    /// or the sensors do not see the same ones, and a smaller RMS than another order's proves
    /// nothing.
    void doubt_what_is_no_noise(const CameraModel& model, const OrderChoice& choice,
                                CameraPairs& result) const;

    Params p_;
};

}  // namespace petal
