// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include "petal/run.hpp"
#include "petal/spec.hpp"
#include "petal/stage.hpp"

namespace petal {

struct MarginPointsParams {
    double margin_step_deg = 0.0;
    double range_threshold = 0.0;
    double beam_deg = 0.28;
    int window = 1;
    int min_points = 5;
    double deflation = 1.0;
};

/// Keeps the points at depth edges: section III.B.1 of the letter and Algorithm 1, lines 1 to 5.
/// docs/margin_points.md tells what is done where the letter is silent.
class MarginPoints final : public Stage {
   public:
    using Params = MarginPointsParams;
    static void describe(Spec<Params>& s);
    explicit MarginPoints(Params p) : p_(p) {}
    void run(Run& run) override;

   private:
    Params p_;
};

}  // namespace petal
