// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include "filters/detail/joining_planes.hpp"
#include "petal/run.hpp"
#include "petal/spec.hpp"
#include "petal/stage.hpp"

namespace petal {

struct DepthContinuousParams : JoiningPlanesParams {
    double voxel_size = 0.5;
    double min_angle_deg = 30.0;
    double max_angle_deg = 90.0;
};

/// `filter.depth_continuous`: keeps the points near lines where two planes join.
class DepthContinuous final : public Stage {
   public:
    using Params = DepthContinuousParams;
    static void describe(Spec<Params>& s);
    explicit DepthContinuous(Params params) : params_(params) {}
    void run(Run& run) override;

   private:
    Params params_;
};

}  // namespace petal
