// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "filters/observation_range.hpp"

namespace petal {

void ObservationRange::describe(Spec<Params>& spec) {
    spec.summary("Drops points of clouds that are nearer or farther than a range.");
    spec.doc(R"(A point stays where min_range <= |p| <= max_range, with |p| its distance from the
origin of the sensor's own frame (the sensor's pose on the vehicle is not applied). A point that
is not finite goes. Filtered are the points maps of `CObservationPointCloud`, of any class: class,
order and all channels (intensity, colour, weight) stay. An observation that loses no point, and
any other observation, goes on as it is.

Points in another form (raw Velodyne packets, range images, 2-D scans) are not touched; the notes
tell of which sensors.)");
    describe_common(spec);
    spec.param("min_range", &Params::min_range).unit("m").within(0.0, 1e6).doc("nearer points go");
    spec.param("max_range", &Params::max_range).unit("m").within(0.0, 1e6).doc("farther points go");
    spec.check([](const Params& p) {
        return p.min_range > p.max_range ? "min_range is above max_range: no point can stay" : "";
    });
}

void ObservationRange::mark(const mrpt::maps::CPointsMap& points, std::vector<bool>& drop) {
    const auto& xs = points.getPointsBufferRef_x();
    const auto& ys = points.getPointsBufferRef_y();
    const auto& zs = points.getPointsBufferRef_z();
    const double min_squared = params_.min_range * params_.min_range;
    const double max_squared = params_.max_range * params_.max_range;
    for (std::size_t i = 0; i < drop.size(); ++i) {
        const double x = xs[i], y = ys[i], z = zs[i];
        const double squared = x * x + y * y + z * z;
        if (squared < min_squared || squared > max_squared) drop[i] = true;
    }
}

}  // namespace petal
