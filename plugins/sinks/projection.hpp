// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include "petal/run.hpp"
#include "petal/spec.hpp"
#include "petal/stage.hpp"

namespace petal {

struct ProjectionParams {
    int point_px = 2;
    int max_points = 200000;
    double min_range = 0.0;
    double max_range = 0.0;
    double photo_brightness = 0.6;
};

/// `sink.projection`: points over the photo, coloured by range.
class Projection final : public Stage {
   public:
    using Params = ProjectionParams;
    static void describe(Spec<Params>& s);
    explicit Projection(Params params) : params_(params) {}
    void finish(Run& run) override;

   private:
    Params params_;
};

}  // namespace petal
