// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "petal/plugin.hpp"

#include "filters/observation_range.hpp"
#include "filters/observation_voxel.hpp"
#include "petal/calibration/observation.hpp"

PETAL_PLUGIN("filters", "0.1.0", [](petal::Registrar& r) {
    r.add<petal::ObservationRange>("filter.observation_range");
    r.add<petal::ObservationVoxel>("filter.observation_voxel");
});
