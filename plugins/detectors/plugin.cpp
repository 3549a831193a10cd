// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "petal/plugin.hpp"

#include "detectors/board_lines.hpp"
#include "detectors/image_contours.hpp"
#include "detectors/image_template.hpp"
#include "detectors/lidar_template.hpp"
#include "detectors/planes_ransac.hpp"

PETAL_PLUGIN("detectors", "0.1.0", [](petal::Registrar& r) {
    r.add<petal::BoardLines>("detector.board_lines");
    r.add<petal::ImageContours>("detector.image_contours");
    r.add<petal::LidarTemplate>("detector.lidar_template");
    r.add<petal::ImageTemplate>("detector.image_template");
    r.add<petal::PlanesRansac>("detector.planes_ransac");
});
