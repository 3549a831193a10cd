// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include "petal/run.hpp"
#include "petal/spec.hpp"
#include "petal/stage.hpp"

namespace petal {

struct ReprojectionMetricParams {};

/// `metric.reprojection`: what the pairs miss by under the extrinsics, in pixels.
class ReprojectionMetric final : public Stage {
   public:
    using Params = ReprojectionMetricParams;
    static void describe(Spec<Params>& s);
    explicit ReprojectionMetric(Params) {}
    void finish(Run& run) override;
};

}  // namespace petal
