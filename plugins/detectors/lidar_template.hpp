// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <string>
#include <vector>

#include "detectors/detail/lidar_template_attempt.hpp"
#include "petal/calibration/boards.hpp"
#include "petal/calibration/cloud.hpp"
#include "petal/calibration/planes.hpp"
#include "petal/run.hpp"
#include "petal/spec.hpp"
#include "petal/stage.hpp"

namespace petal {

struct LidarTemplateParams : PlateLimits, PlateEdgeLimits {
    std::string target = "four_square_holes_500mm";
    std::string evidence = "auto";
    int max_candidates = 40;
    double edge_shift_sigma_level = 0.006;
    double edge_shift_sigma_upright = 0.010;
};

/// Boards anywhere in a cloud, by fitting the target's outline and holes to all rays around each
/// plate that stands free.
class LidarTemplate final : public Stage {
   public:
    using Params = LidarTemplateParams;
    static void describe(Spec<Params>& s);
    explicit LidarTemplate(Params p) : p_(std::move(p)) {}
    /// \throws Error when the target cannot be read.
    void run(Run& run) override;

   private:
    void tell_nothing(Run& run, const std::vector<PlateAttempt>& attempts,
                      const PlateCandidate& nearest, std::size_t points) const;

    Params p_;
};

}  // namespace petal
