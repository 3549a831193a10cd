// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include "detectors/detail/lidar_template_likelihood.hpp"
#include "detectors/detail/lidar_template_rays.hpp"

namespace petal {

struct PlateTemplate;

/// Where rays were sent and none returned. The density of rays is that of the hits on the plate
/// nearby (a Gaussian mean); in each hole, and beyond each side of the outline where that counts,
/// the share of the rays expected off the edges that returned tells how many did not. Fills
/// `zone.silent`; `rays` are in the board's plane. Returns the mean density on the plate, rays/m^2.
double add_silent(const PlateTemplate& target, const RayBundle& rays, double margin,
                  ToldRays& zone);

/// 1 - log L / log L_0, where L_0 knows only the share of hits.
double gain_over_share(const ToldRays& zone, double log_likelihood);

}  // namespace petal
