// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include "petal/run.hpp"
#include "petal/spec.hpp"
#include "petal/stage.hpp"

namespace petal {

struct SparsePointsParams {
    double distance = 0.03;
    int min_neighbours = 6;
};

/// `filter.sparse_points`: drops points by the descriptor N of section III.B.1 of the letter.
class SparsePoints final : public Stage {
   public:
    using Params = SparsePointsParams;
    static void describe(Spec<Params>& s);
    explicit SparsePoints(Params params) : params_(params) {}
    void run(Run& run) override;

   private:
    Params params_;
};

}  // namespace petal
