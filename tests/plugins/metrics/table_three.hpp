// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <optional>
#include <string>

#include "petal/calibration/boards.hpp"
#include "petal/calibration/camera_model.hpp"
#include "petal/calibration/correspondences.hpp"
#include "petal/calibration/extrinsics.hpp"
#include "petal/calibration/metrics.hpp"
#include "petal/calibration/target.hpp"
#include "petal/testing/stage_harness.hpp"

namespace petal::table_three {

inline const char* const kBoard = "four_square_holes_500mm";
constexpr double kDepth = 4.0;    // m
constexpr double kFocal = 800.0;  // px

inline mrpt::img::TCamera true_camera() {
    mrpt::img::TCamera camera;
    camera.ncols = 1280;
    camera.nrows = 720;
    camera.setIntrinsicParamsFromValues(kFocal, kFocal, 640.0, 360.0);
    return camera;
}

/// LiDAR and camera frames are one; a board straight ahead, seen without error.
inline Correspondences pairs(const std::string& name = "hall") {
    CameraPairs seen;
    seen.scene_name = name;
    seen.camera = "CAMERA";
    seen.lidar = "LIDAR";
    seen.model = true_camera();
    const CameraModel model(seen.model);
    seen.boards.emplace_back();
    seen.boards[0].lidar = 0;
    int index = 0;
    for (const Eigen::Vector2d& corner : load_target(kBoard).corners()) {
        PointPair pair;
        pair.lidar = {corner.x() - 0.25, corner.y() - 0.25, kDepth};
        pair.image = *model.project(pair.lidar);
        pair.board = 0;
        pair.corner = index++;
        seen.pairs.push_back(pair);
    }
    return Correspondences{{seen}};
}

inline Extrinsics pose(const Eigen::Vector3d& shift, bool with_model = true) {
    CameraExtrinsics camera;
    camera.camera = "CAMERA";
    camera.lidar = "LIDAR";
    if (with_model) camera.model = true_camera();
    camera.T_camera_lidar.translation() = shift;
    Extrinsics extrinsics;
    extrinsics.cameras.push_back(camera);
    return extrinsics;
}

inline LidarBoards boards() {
    LidarBoard board;
    board.target = kBoard;
    return LidarBoards{"LIDAR", {board}};
}

template <class Metric>
testing::StageHarness measured(const Extrinsics& extrinsics, const Correspondences& pairs) {
    testing::StageHarness stage = testing::StageHarness::of<Metric>();
    stage.give<Extrinsics>("extrinsics", extrinsics);
    stage.give<Correspondences>("correspondences", pairs, "hall");
    if (stage.spec().find_input("lidar_boards") != nullptr)
        stage.give<LidarBoards>("lidar_boards", boards(), "hall");
    stage.fire();
    return stage;
}

inline std::optional<double> figure_of(const testing::StageHarness& stage, const std::string& name,
                                       const std::string& scene = "") {
    for (const Metric& metric : stage.out<Metrics>("metrics").values)
        if (metric.name == name && metric.scene == scene) return metric.value;
    return std::nullopt;
}

}  // namespace petal::table_three
