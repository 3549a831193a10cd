// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <string>
#include <utility>

#include "petal/run.hpp"
#include "petal/spec.hpp"
#include "petal/stage.hpp"

namespace petal {

struct TruthMetricParams {
    std::string camera;
    std::string lidar;
};

/// `metric.truth`: how far the extrinsics are from the true pose of simulated scenes.
class TruthMetric final : public Stage {
   public:
    using Params = TruthMetricParams;
    static void describe(Spec<Params>& s);
    explicit TruthMetric(Params params) : params_(std::move(params)) {}
    void finish(Run& run) override;

   private:
    Params params_;
};

}  // namespace petal
