// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include "petal/run.hpp"
#include "petal/spec.hpp"
#include "petal/stage.hpp"

namespace petal {

struct NormalisedReprojectionMetricParams {
    int expected_corners = 0;
};

/// `metric.normalised_reprojection`: the letter's Table II.
class NormalisedReprojectionMetric final : public Stage {
   public:
    using Params = NormalisedReprojectionMetricParams;
    static void describe(Spec<Params>& s);
    explicit NormalisedReprojectionMetric(Params params) : params_(params) {}
    void finish(Run& run) override;

   private:
    Params params_;
};

}  // namespace petal
