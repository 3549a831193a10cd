// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <string>

#include "petal/spec.hpp"
#include "petal/stage.hpp"
#include "solvers/detail/solver_params.hpp"

namespace petal {

struct PnpParams : SolverParams {
    PnpParams() {}  // not an aggregate: GCC 12 warns of one with such bases
    std::string method = "sqpnp";
};

/// `solver.pnp`: OpenCV's solvers in the place of petal's own.
class Pnp final : public Stage {
   public:
    using Params = PnpParams;
    static void describe(Spec<Params>& s);
    explicit Pnp(Params params) : p_(std::move(params)) {}
    void finish(Run& run) override;

   private:
    Params p_;
};

}  // namespace petal
