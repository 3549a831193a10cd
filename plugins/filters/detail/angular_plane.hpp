// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

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
        return here > 0.0F ? point.range - 1.0F / here : 0.0F;
    }
};

}  // namespace petal
