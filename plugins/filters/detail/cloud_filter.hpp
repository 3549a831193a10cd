// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <mrpt/maps/CPointsMap.h>

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "petal/calibration/observation.hpp"
#include "petal/run.hpp"
#include "petal/spec.hpp"
#include "petal/stage.hpp"

namespace petal {

struct CloudFilterParams {
    std::vector<std::string> labels;
};

/// What the observation filters have in common: points of a CObservationPointCloud are dropped, the
/// rest (class of the map, all channels, order) stays; everything else goes on as it is, the very
/// same object. What it did is told once, at the end: a stream may have millions of frames.
class CloudFilter : public Stage {
   public:
    /// Role, ports and `labels`; `Params` derives from CloudFilterParams.
    template <class Params>
    static void describe_common(Spec<Params>& spec) {
        spec.role("observation_filter");
        spec.template reads<Observation>("observation", "any observation");
        spec.template writes<Observation>("observation",
                                          "the same, or a copy with fewer points in its cloud");
        spec.param("labels", &CloudFilterParams::labels)
            .doc("sensor labels or shell patterns whose clouds are filtered; empty: all");
    }
    void run(Run& run) final;
    void finish(Run& run) final;

   protected:
    explicit CloudFilter(std::vector<std::string> labels) : labels_(std::move(labels)) {}
    /// Marks the points to be dropped in `drop`, which has an entry for each point. Those that are
    /// not finite are marked already.
    virtual void mark(const mrpt::maps::CPointsMap& points, std::vector<bool>& drop) = 0;

   private:
    /// Whether the observation goes on as it is; counts it.
    bool passes(const mrpt::obs::CObservation& observation);

    std::vector<std::string> labels_;
    std::vector<bool> drop_;
    std::uint64_t clouds_ = 0;
    std::uint64_t points_ = 0;
    std::uint64_t kept_ = 0;
    std::uint64_t not_finite_ = 0;
    std::uint64_t passed_ = 0;
    /// Sensors whose points lie in another form, and how many observations of them passed.
    std::map<std::string, std::uint64_t> other_forms_;
};

}  // namespace petal
