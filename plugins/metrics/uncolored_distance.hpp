// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include "petal/run.hpp"
#include "petal/spec.hpp"
#include "petal/stage.hpp"

namespace petal {

struct UncoloredDistanceParams {};

/// `metric.uncolored_distance`: equation (17).
class UncoloredDistance final : public Stage {
   public:
    using Params = UncoloredDistanceParams;
    static void describe(Spec<Params>& s);
    explicit UncoloredDistance(Params) {}
    void finish(Run& run) override;
};

}  // namespace petal
