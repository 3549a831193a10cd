// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include "petal/run.hpp"
#include "petal/spec.hpp"
#include "petal/stage.hpp"

namespace petal {

struct StillPointsParams {
    double min_still = 2.0;
};

/// `filter.still_points`: the points of the part of a capture in which no board moved.
class StillPoints final : public Stage {
   public:
    using Params = StillPointsParams;
    static void describe(Spec<Params>& s);
    explicit StillPoints(Params params) : p_(params) {}
    void run(Run& run) override;

   private:
    Params p_;
};

}  // namespace petal
