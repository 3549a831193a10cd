// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include "petal/run.hpp"
#include "petal/spec.hpp"
#include "petal/stage.hpp"

namespace petal {

struct StatisticalOutlierParams {
    int neighbours = 8;
    double max_deviations = 2.0;
};

/// `filter.statistical_outlier`: drops points that are unusually far from their neighbours.
class StatisticalOutlier final : public Stage {
   public:
    using Params = StatisticalOutlierParams;
    static void describe(Spec<Params>& s);
    explicit StatisticalOutlier(Params params) : params_(params) {}
    void run(Run& run) override;

   private:
    Params params_;
};

}  // namespace petal
