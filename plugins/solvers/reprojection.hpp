// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <string>

#include "petal/spec.hpp"
#include "petal/stage.hpp"
#include "solvers/detail/solver_params.hpp"

namespace petal {

struct ReprojectionParams : SolverParams {
    ReprojectionParams() {}  // not an aggregate: GCC 12 warns of one with such bases
    std::string robust_loss = "none";
    double loss_scale_px = 2.0;
};

/// `solver.reprojection`: the letter's equations (8) to (15), corrected.
class Reprojection final : public Stage {
   public:
    using Params = ReprojectionParams;
    static void describe(Spec<Params>& s);
    explicit Reprojection(Params params) : p_(std::move(params)) {}
    void finish(Run& run) override;

   private:
    Params p_;
};

}  // namespace petal
