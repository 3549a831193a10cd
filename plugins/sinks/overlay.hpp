// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include "petal/run.hpp"
#include "petal/spec.hpp"
#include "petal/stage.hpp"

namespace petal {

struct OverlayParams {
    int magnification = 0;
    double residual_scale = 10.0;
    int max_points = 200000;
};

/// Draws what a calibration means on the photo.
class Overlay final : public Stage {
   public:
    using Params = OverlayParams;
    static void describe(Spec<Params>& s);
    explicit Overlay(Params params) : params_(params) {}
    void finish(Run& run) override;

   private:
    Params params_;
};

}  // namespace petal
