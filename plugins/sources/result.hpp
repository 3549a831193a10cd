// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <filesystem>
#include <utility>

#include "petal/run.hpp"
#include "petal/spec.hpp"
#include "petal/stage.hpp"

namespace petal {

struct ResultSourceParams {
    std::filesystem::path file = "${data}/result.json";
};

/// `source.result`: the extrinsics of an earlier run.
class ResultSource final : public Stage {
   public:
    using Params = ResultSourceParams;
    static void describe(Spec<Params>& spec);
    explicit ResultSource(Params params) : params_(std::move(params)) {}
    void run(Run& run) override;

   private:
    Params params_;
    bool done_ = false;
};

}  // namespace petal
