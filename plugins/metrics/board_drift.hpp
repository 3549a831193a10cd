// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include "petal/run.hpp"
#include "petal/spec.hpp"
#include "petal/stage.hpp"

namespace petal {

struct BoardDriftParams {};

/// `metric.board_drift`: equation (16).
class BoardDrift final : public Stage {
   public:
    using Params = BoardDriftParams;
    static void describe(Spec<Params>& s);
    explicit BoardDrift(Params) {}
    void finish(Run& run) override;
};

}  // namespace petal
