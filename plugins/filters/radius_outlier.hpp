// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include "petal/run.hpp"
#include "petal/spec.hpp"
#include "petal/stage.hpp"

namespace petal {

struct RadiusOutlierParams {
    double radius = 0.15;
    int min_neighbours = 6;
};

/// `filter.radius_outlier`: drops points that have too few others in a ball.
class RadiusOutlier final : public Stage {
   public:
    using Params = RadiusOutlierParams;
    static void describe(Spec<Params>& s);
    explicit RadiusOutlier(Params params) : params_(params) {}
    void run(Run& run) override;

   private:
    Params params_;
};

}  // namespace petal
