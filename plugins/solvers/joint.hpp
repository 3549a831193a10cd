// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <utility>

#include "petal/spec.hpp"
#include "petal/stage.hpp"
#include "solvers/detail/joint_params.hpp"

namespace petal {

/// `solver.joint`: all scenes, boards and cameras of a LiDAR in one problem, and what the result is
/// worth.
class Joint final : public Stage {
   public:
    using Params = JointParams;
    static void describe(Spec<Params>& s);
    explicit Joint(Params params) : p_(std::move(params)) {}
    void finish(Run& run) override;

   private:
    Params p_;
};

}  // namespace petal
