// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include "filters/detail/cloud_filter.hpp"

namespace petal {

struct ObservationVoxelParams : CloudFilterParams {
    double size = 0.1;
};

/// Keeps one point of clouds in each cell of a grid.
class ObservationVoxel final : public CloudFilter {
   public:
    using Params = ObservationVoxelParams;
    static void describe(Spec<Params>& spec);
    explicit ObservationVoxel(Params params)
        : CloudFilter(params.labels), params_(std::move(params)) {}

   private:
    void mark(const mrpt::maps::CPointsMap& points, std::vector<bool>& drop) override;

    Params params_;
};

}  // namespace petal
