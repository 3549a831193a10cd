// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <filesystem>
#include <string>

#include "petal/run.hpp"
#include "petal/spec.hpp"
#include "petal/stage.hpp"

namespace petal {

struct ResultParams {
    std::filesystem::path file = "result.json";
};

/// Writes the product of a calibration, result.json.
class ResultSink final : public Stage {
   public:
    using Params = ResultParams;
    static void describe(Spec<Params>& s);
    explicit ResultSink(Params params) : params_(std::move(params)) {}
    void finish(Run& run) override;

   private:
    Params params_;
};

}  // namespace petal
