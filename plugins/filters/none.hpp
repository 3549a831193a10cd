// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include "petal/run.hpp"
#include "petal/spec.hpp"
#include "petal/stage.hpp"

namespace petal {

struct NoFilterParams {};

/// `filter.none`: passes the cloud on.
class NoFilter final : public Stage {
   public:
    using Params = NoFilterParams;
    static void describe(Spec<Params>& s);
    explicit NoFilter(Params) {}
    void run(Run& run) override;
};

}  // namespace petal
