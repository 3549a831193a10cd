// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include "petal/run.hpp"
#include "petal/spec.hpp"
#include "petal/stage.hpp"

namespace example {

struct StatisticalOutlierParams {
    int neighbours = 8;
    double max_deviations = 2.0;
};

/// Drops points whose mean distance to their nearest neighbours is unusually large.
class StatisticalOutlier final : public petal::Stage {
   public:
    using Params = StatisticalOutlierParams;
    static void describe(petal::Spec<Params>& spec);
    explicit StatisticalOutlier(Params params) : params_(params) {}
    void run(petal::Run& run) override;

   private:
    Params params_;
};

}  // namespace example
