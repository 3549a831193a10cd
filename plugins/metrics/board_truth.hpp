// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <string>
#include <utility>

#include "petal/run.hpp"
#include "petal/spec.hpp"
#include "petal/stage.hpp"

namespace petal {

struct BoardTruthParams {
    double range_offset_sigma = 0.005;
    std::string camera;
};

/// `metric.board_truth`: how far the boards that detectors found are from the true ones, in metres,
/// pixels and in their own sigmas.
class BoardTruthMetric final : public Stage {
   public:
    using Params = BoardTruthParams;
    static void describe(Spec<Params>& s);
    explicit BoardTruthMetric(Params params) : params_(std::move(params)) {}
    void finish(Run& run) override;

   private:
    Params params_;
};

}  // namespace petal
