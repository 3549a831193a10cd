// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "petal/plugin.hpp"

#include "metrics/agreement.hpp"
#include "metrics/board_check.hpp"
#include "metrics/board_drift.hpp"
#include "metrics/board_truth.hpp"
#include "metrics/intrinsics_check.hpp"
#include "metrics/labels.hpp"
#include "metrics/normalised_reprojection.hpp"
#include "metrics/plane_points.hpp"
#include "metrics/reprojection.hpp"
#include "metrics/stillness.hpp"
#include "metrics/truth.hpp"
#include "metrics/uncolored_distance.hpp"
#include "petal/calibration/metrics.hpp"

PETAL_PLUGIN("metrics", "0.1.0", [](petal::Registrar& r) {
    r.add<petal::AgreementMetric>("metric.agreement");
    r.add<petal::BoardCheck>("metric.board_check");
    r.add<petal::BoardDrift>("metric.board_drift");
    r.add<petal::BoardTruthMetric>("metric.board_truth");
    r.add<petal::IntrinsicsCheck>("metric.intrinsics_check");
    r.add<petal::LabelsMetric>("metric.labels");
    r.add<petal::NormalisedReprojectionMetric>("metric.normalised_reprojection");
    r.add<petal::PlanePointsMetric>("metric.plane_points");
    r.add<petal::ReprojectionMetric>("metric.reprojection");
    r.add<petal::StillnessMetric>("metric.stillness");
    r.add<petal::TruthMetric>("metric.truth");
    r.add<petal::UncoloredDistance>("metric.uncolored_distance");
});
