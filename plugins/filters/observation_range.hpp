// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include "filters/detail/cloud_filter.hpp"

namespace petal {

struct ObservationRangeParams : CloudFilterParams {
    double min_range = 0.1;
    double max_range = 200.0;
};

/// Keeps the points of clouds between two ranges.
class ObservationRange final : public CloudFilter {
   public:
    using Params = ObservationRangeParams;
    static void describe(Spec<Params>& spec);
    explicit ObservationRange(Params params)
        : CloudFilter(params.labels), params_(std::move(params)) {}

   private:
    void mark(const mrpt::maps::CPointsMap& points, std::vector<bool>& drop) override;

    Params params_;
};

}  // namespace petal
