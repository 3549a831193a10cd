// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "detectors/detail/lidar_template_background.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace petal {
namespace {

/// rad: what a beam that leaves the plate by this may touch of it. Half the height of a Mid-70's.
constexpr double kHalfBeam = 0.0025;
constexpr double kLeastBehind = 0.010;   ///< m
constexpr double kRaysOfSide = 8.0;      ///< with fewer, its background is unknown
constexpr double kAlike = 0.15;          ///< logarithm
constexpr double kMostBrightness = 2.0;  ///< logarithm: more is a mirror or nothing at all

/// What is nearly as bright differs as much by how far behind it is, which moves edges too and is
/// not known: a factor that followed such differences came out four times too large.
double beyond_likeness(double brightness) {
    const double off = std::min(std::abs(brightness), kMostBrightness) - kAlike;
    return off > 0.0 ? std::copysign(off, brightness) : 0.0;
}

struct Behind {
    double sum = 0.0, rays = 0.0;
};

}  // namespace

std::vector<double> backgrounds_of(const PlateShape& shape, const RayBundle& rays) {
    const double reach =
        std::max(kLeastBehind, kHalfBeam * rays.T_lidar_plane.translation().norm());
    std::vector<Behind> sides(shape.side_count());
    for (const PlaneRay& ray : rays.rays) {
        if (rays.told(ray) != Told::miss || !shape.in_zone(ray.place)) continue;
        if (shape.beyond(ray.place, reach) != 0) continue;
        const PlateShape::Edge edge = shape.edge(ray.place);
        if (edge.inside >= 0.0) continue;
        Behind& side = sides[static_cast<std::size_t>(edge.side)];
        side.sum += ray.log_energy;
        side.rays += 1.0;
    }
    double mean = 0.0, known = 0.0;
    for (const Behind& side : sides) {
        if (side.rays < kRaysOfSide) continue;
        mean += side.sum / side.rays;
        known += 1.0;
    }
    std::vector<double> brightness(sides.size(), 0.0);
    for (std::size_t s = 0; s < sides.size(); ++s)
        if (sides[s].rays >= kRaysOfSide)
            brightness[s] = beyond_likeness(sides[s].sum / sides[s].rays - mean / known);
    return brightness;
}

}  // namespace petal
