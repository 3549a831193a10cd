// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "metrics/reprojection.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <optional>

#include "petal/calibration/camera_model.hpp"
#include "petal/calibration/correspondences.hpp"
#include "petal/calibration/extrinsics.hpp"
#include "petal/calibration/metrics.hpp"
#include "petal/testing/stage_harness.hpp"
#include "plugins/solvers/real_pairs.hpp"
#include "real_data.hpp"

namespace petal {
namespace {

using testing::StageHarness;

mrpt::img::TCamera camera() {
    return testing::indoor_camera();
}

Extrinsics identity() {
    CameraExtrinsics solved;
    solved.camera = "CAMERA";
    solved.lidar = "LIDAR";
    solved.model = camera();
    Extrinsics extrinsics;
    extrinsics.cameras.push_back(solved);
    return extrinsics;
}

/// A point on the axis at some depth, seen off by an error; of a board, or single.
PointPair pair_off(double depth, Eigen::Vector2d error, int board) {
    PointPair pair;
    pair.lidar = Eigen::Vector3d(0.0, 0.0, depth);
    pair.image = Eigen::Vector2d(camera().cx(), camera().cy()) + error;
    pair.board = board;
    return pair;
}

Correspondences scene(std::vector<PointPair> pairs, std::uint64_t number = 0,
                      std::string name = "") {
    CameraPairs seen;
    seen.scene = number;
    seen.scene_name = std::move(name);
    seen.camera = "CAMERA";
    seen.lidar = "LIDAR";
    seen.model = camera();
    seen.pairs = std::move(pairs);
    return Correspondences{{seen}};
}

std::optional<double> figure(const StageHarness& stage, const std::string& name,
                             const std::string& in_scene = "") {
    for (const Metric& metric : stage.out<Metrics>("metrics").values)
        if (metric.name == "reprojection." + name && metric.scene == in_scene) return metric.value;
    return std::nullopt;
}

TEST(ReprojectionMetric, FiguresOfKnownErrors) {
    auto stage = StageHarness::of<ReprojectionMetric>("metric.reprojection");
    stage.give<Extrinsics>("extrinsics", identity());
    stage.give<Correspondences>(
        "correspondences",
        scene({pair_off(2.0, {3.0, -4.0}, 0), pair_off(4.0, {0.0, 1.0}, -1)}, 0, "a"));
    stage.give<Correspondences>("correspondences", scene({pair_off(4.0, {0.0, 0.0}, 0)}, 1, "b"));
    stage.fire();
    EXPECT_DOUBLE_EQ(*figure(stage, "count"), 3.0);
    EXPECT_NEAR(*figure(stage, "rms_px"), std::sqrt(26.0 / 3.0), 1e-12);
    EXPECT_NEAR(*figure(stage, "mean_px"), 2.0, 1e-12);
    EXPECT_NEAR(*figure(stage, "median_px"), 1.0, 1e-12);
    EXPECT_NEAR(*figure(stage, "max_px"), 5.0, 1e-12);
    // (3 + 4) * 2 / 4 + 1 over six values.
    EXPECT_NEAR(*figure(stage, "normalised_px"), 4.5 / 6.0, 1e-12);
    EXPECT_NEAR(*figure(stage, "board_drift_px"), 2.5, 1e-12);
    EXPECT_NEAR(*figure(stage, "mean_px", "a"), 3.0, 1e-12);
    EXPECT_NEAR(*figure(stage, "rms_px", "b"), 0.0, 1e-12);
    EXPECT_TRUE(stage.notes().empty());
}

TEST(ReprojectionMetric, NoBoardNoDrift) {
    auto stage = StageHarness::of<ReprojectionMetric>();
    stage.give<Extrinsics>("extrinsics", identity());
    stage.give<Correspondences>("correspondences", scene({pair_off(2.0, {1.0, 0.0}, -1)}));
    stage.fire();
    EXPECT_FALSE(figure(stage, "board_drift_px"));
    EXPECT_TRUE(figure(stage, "rms_px", "0"));  // a scene without a name is told by its number
}

TEST(ReprojectionMetric, NothingToMeasureIsTold) {
    auto stage = StageHarness::of<ReprojectionMetric>();
    stage.give<Extrinsics>("extrinsics", Extrinsics{});
    stage.give<Correspondences>("correspondences", scene({pair_off(2.0, {1.0, 0.0}, 0)}));
    stage.fire();
    EXPECT_DOUBLE_EQ(*figure(stage, "count"), 0.0);
    EXPECT_FALSE(figure(stage, "rms_px"));
    EXPECT_EQ(stage.notes().size(), 1u);

    auto behind = StageHarness::of<ReprojectionMetric>();
    behind.give<Extrinsics>("extrinsics", identity());
    behind.give<Correspondences>(
        "correspondences", scene({pair_off(-2.0, {0.0, 0.0}, 0), pair_off(2.0, {1.0, 0.0}, 0)}));
    behind.fire();
    EXPECT_DOUBLE_EQ(*figure(behind, "count"), 1.0);
    EXPECT_EQ(behind.notes().size(), 1u);
}

TEST(ReprojectionMetric, PublishedPoseOnPublishedPairs) {
    PETAL_NEEDS_REAL_DATA();
    const auto data = testing::real_data();
    auto extrinsics = identity();
    extrinsics.cameras[0].T_camera_lidar =
        testing::published_pose(data / "sjtu_indoor/published_extrinsic.txt");
    auto stage = StageHarness::of<ReprojectionMetric>();
    stage.give<Extrinsics>("extrinsics", extrinsics);
    stage.give<Correspondences>("correspondences", scene(testing::indoor_pairs(data)));
    stage.fire();
    EXPECT_NEAR(*figure(stage, "rms_px"), 1.055, 0.002);
    EXPECT_LT(*figure(stage, "normalised_px"), *figure(stage, "mean_px"));
}

}  // namespace
}  // namespace petal
