// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "metrics/detail/board_edges.hpp"
#include "metrics/detail/board_motion.hpp"
#include "petal/calibration/images.hpp"
#include "petal/calibration/metrics.hpp"
#include "petal/run.hpp"
#include "petal/spec.hpp"
#include "petal/stage.hpp"

namespace petal {

struct StillnessParams {
    double split = 2.0;
    int max_splits = 10;
    double sigmas = 3.0;
    double min_motion = 0.002;
    std::vector<std::filesystem::path> targets;
};

/// `metric.stillness`: whether the boards stood still while the sensors looked.
class StillnessMetric final : public Stage {
   public:
    using Params = StillnessParams;
    static void describe(Spec<Params>& s);
    explicit StillnessMetric(Params params) : p_(std::move(params)), targets_(p_.targets) {}
    void run(Run& run) override;

   private:
    void look_at_points(Run& run, Metrics& metrics);
    void look_at_images(Run& run, Metrics& metrics);

    Params p_;
    TargetsByName targets_;
};

}  // namespace petal
