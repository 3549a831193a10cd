// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <filesystem>
#include <utility>
#include <vector>

#include "metrics/detail/board_edges.hpp"
#include "petal/run.hpp"
#include "petal/spec.hpp"
#include "petal/stage.hpp"

namespace petal {

struct AgreementParams {
    double sigmas = 3.0;
    double max_px = 1.0;
    double usable_sigma = 0.005;
    double usable_sigma_deg = 0.06;
    double reach = 1.5;
    double lidar_sigma = 0.005;
    double board_redundancy = 4.0;
    std::vector<std::filesystem::path> targets;
};

/// `metric.agreement`: holds known extrinsics against boards of new scenes, without solving.
class AgreementMetric final : public Stage {
   public:
    using Params = AgreementParams;
    static void describe(Spec<Params>& s);
    explicit AgreementMetric(Params params) : p_(std::move(params)), targets_(p_.targets) {}
    void finish(Run& run) override;

   private:
    Params p_;
    TargetsByName targets_;
};

}  // namespace petal
