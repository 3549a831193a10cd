// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <cmath>

#include "filters/detail/angular_cells.hpp"

namespace petal {

/// A plane near one direction: the inverse of the range to it is linear in small angles.
struct AngularPlane {
    float inverse = 0.0F;                    ///< 1/m, at:
    float azimuth = 0.0F, elevation = 0.0F;  ///< rad
    float across = 0.0F, up = 0.0F;          ///< change of the inverse with both, 1/m/rad

    /// m that a point lies behind it along its ray; 0 for rays that pass the plane by.
    float behind(const AngularPoint& point) const {
        const float here =
            inverse + across * (point.azimuth - azimuth) + up * (point.elevation - elevation);
        // Without a branch, so that loops over points are vectorised.
        constexpr float kLeast = 1e-9F;
        const float meets = 0.5F + std::copysign(0.5F, here);
        return meets * (point.range - 1.0F / (std::abs(here) + kLeast));
    }
};

}  // namespace petal
