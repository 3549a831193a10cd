// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include "petal/run.hpp"
#include "petal/spec.hpp"
#include "petal/stage.hpp"

namespace petal {

struct NearestPointsParams {
    double margin_step_deg = 0.2;
    double distance = 0.02;
    double range_threshold = 0.3;
};

/// `filter.nearest_points`: keeps what is as near as the nearest point of its angular cell.
class NearestPoints final : public Stage {
   public:
    using Params = NearestPointsParams;
    static void describe(Spec<Params>& s);
    explicit NearestPoints(Params params) : params_(params) {}
    void run(Run& run) override;

   private:
    Params params_;
};

}  // namespace petal
