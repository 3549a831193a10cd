// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include "petal/run.hpp"
#include "petal/spec.hpp"
#include "petal/stage.hpp"
#include "solvers/detail/order_choice.hpp"

namespace petal {

struct BoardMatcherParams : OrderParams, GateParams {
    BoardMatcherParams() {}  // not an aggregate: GCC 12 warns of one with such bases
    bool use_distortion = true;
    int max_image_boards = 12;
};

/// `solver.board_matcher`: which LiDAR board is which image board, in which rotation, decided over
/// all scenes together.
class BoardMatcher final : public Stage {
   public:
    using Params = BoardMatcherParams;
    static void describe(Spec<Params>& s);
    explicit BoardMatcher(Params params) : p_(params) {}
    void finish(Run& run) override;

   private:
    Params p_;
};

}  // namespace petal
