// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "petal/plugin.hpp"

#include "filters/depth_continuous.hpp"
#include "filters/margin_points.hpp"
#include "filters/nearest_points.hpp"
#include "filters/none.hpp"
#include "filters/observation_range.hpp"
#include "filters/observation_voxel.hpp"
#include "filters/radius_outlier.hpp"
#include "filters/sparse_points.hpp"
#include "filters/statistical_outlier.hpp"
#include "filters/still_points.hpp"
#include "petal/calibration/observation.hpp"

PETAL_PLUGIN("filters", "0.1.0", [](petal::Registrar& r) {
    r.add<petal::DepthContinuous>("filter.depth_continuous");
    r.add<petal::MarginPoints>("filter.margin_points");
    r.add<petal::NearestPoints>("filter.nearest_points");
    r.add<petal::NoFilter>("filter.none");
    r.add<petal::ObservationRange>("filter.observation_range");
    r.add<petal::ObservationVoxel>("filter.observation_voxel");
    r.add<petal::RadiusOutlier>("filter.radius_outlier");
    r.add<petal::SparsePoints>("filter.sparse_points");
    r.add<petal::StatisticalOutlier>("filter.statistical_outlier");
    r.add<petal::StillPoints>("filter.still_points");
});
