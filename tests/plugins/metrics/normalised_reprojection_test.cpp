// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "metrics/normalised_reprojection.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <optional>

#include "metrics/reprojection.hpp"
#include "petal/calibration/correspondences.hpp"
#include "petal/calibration/extrinsics.hpp"
#include "petal/calibration/metrics.hpp"
#include "petal/calibration/truth.hpp"
#include "petal/testing/stage_harness.hpp"

namespace petal {
namespace {

using ::testing::HasSubstr;
using testing::StageHarness;

/// An ideal camera: a point on the axis lies at pixel (320, 240).
Extrinsics known_pose() {
    CameraExtrinsics solved;
    solved.camera = "CAMERA";
    solved.lidar = "LIDAR";
    solved.model.ncols = 640;
    solved.model.nrows = 480;
    solved.model.setIntrinsicParamsFromValues(500.0, 500.0, 320.0, 240.0);
    Extrinsics extrinsics;
    extrinsics.cameras.push_back(solved);
    return extrinsics;
}

PointPair missed_by(double du, double dv, double range) {
    PointPair pair;
    pair.lidar = Eigen::Vector3d(0.0, 0.0, range);
    pair.image = Eigen::Vector2d(320.0 + du, 240.0 + dv);
    pair.board = 0;
    return pair;
}

Correspondences seen(std::vector<PointPair> pairs, const std::string& camera = "CAMERA") {
    CameraPairs one;
    one.camera = camera;
    one.lidar = "LIDAR";
    one.pairs = std::move(pairs);
    return Correspondences{{one}};
}

Truth boards(std::size_t count) {
    Truth truth;
    truth.boards.resize(count);
    for (Truth::Board& board : truth.boards)
        board.corners_lidar.resize(16, Eigen::Vector3d(1.0, 0.0, 0.0));
    return truth;
}

template <class S = NormalisedReprojectionMetric>
StageHarness metric_of(const std::vector<Correspondences>& scenes, Extrinsics pose = known_pose()) {
    auto stage = StageHarness::of<S>();
    stage.template give<Extrinsics>("extrinsics", std::move(pose));
    // One packet of all scenes, as the matcher writes it: "a", "b", ...
    Correspondences all;
    for (std::size_t i = 0; i < scenes.size(); ++i)
        for (CameraPairs camera : scenes[i].cameras) {
            camera.scene = i;
            camera.scene_name = static_cast<char>('a' + i);
            all.cameras.push_back(std::move(camera));
        }
    stage.template give<Correspondences>("correspondences", all);
    return stage;
}

std::optional<double> told_of(const StageHarness& stage, const std::string& name,
                              const std::string& scene = "",
                              const std::string& group = "normalised_reprojection.") {
    for (const Metric& metric : stage.out<Metrics>("metrics").values)
        if (metric.name == group + name && metric.scene == scene) return metric.value;
    return std::nullopt;
}

/// Eight values: 3, 4 at half the largest range; 0, 12; 0.5, 0.75; 10, 5 at a quarter.
const std::vector<PointPair> kFour = {missed_by(3, -4, 4.0), missed_by(0, 12, 8.0),
                                      missed_by(-0.5, 0.75, 8.0), missed_by(40, -20, 2.0)};

TEST(NormalisedReprojectionMetric, TableTwoByHand) {
    auto stage = metric_of({seen(kFour)});
    stage.set("expected_corners", 4).fire();
    for (const char* scene : {"", "a"}) {
        EXPECT_EQ(told_of(stage, "count", scene), 4.0);
        EXPECT_EQ(told_of(stage, "expected", scene), 4.0);
        EXPECT_EQ(told_of(stage, "largest_range", scene), 8.0);
        // Normalised: 1.5, 2; 0, 12; 0.5, 0.75; 10, 5. Their sum is 31.75.
        EXPECT_NEAR(*told_of(stage, "mean_px", scene), 31.75 / 8.0, 1e-12);
        const double squares = 1.5 * 1.5 + 4.0 + 144.0 + 0.25 + 0.75 * 0.75 + 100.0 + 25.0;
        EXPECT_NEAR(*told_of(stage, "deviation_px", scene),
                    std::sqrt(squares / 8.0 - std::pow(31.75 / 8.0, 2)), 1e-12);
        EXPECT_DOUBLE_EQ(*told_of(stage, "below_1px_share", scene), 3.0 / 8.0);
        EXPECT_DOUBLE_EQ(*told_of(stage, "below_5px_share", scene), 5.0 / 8.0);  // 5 is not below 5
        EXPECT_DOUBLE_EQ(*told_of(stage, "below_10px_share", scene), 6.0 / 8.0);  // nor 10 below 10
        // In two dimensions: 2.5, 12, 0.9014, 11.1803.
        EXPECT_NEAR(*told_of(stage, "norm_mean_px", scene),
                    (2.5 + 12.0 + std::hypot(0.5, 0.75) + std::hypot(10.0, 5.0)) / 4.0, 1e-12);
        EXPECT_DOUBLE_EQ(*told_of(stage, "norm_below_1px_share", scene), 0.25);
        EXPECT_DOUBLE_EQ(*told_of(stage, "norm_below_5px_share", scene), 0.5);
        EXPECT_DOUBLE_EQ(*told_of(stage, "norm_below_10px_share", scene), 0.5);
    }
    EXPECT_TRUE(stage.notes().empty());
}

TEST(NormalisedReprojectionMetric, ItsMeanIsThatOfTheReprojectionMetric) {
    const std::vector<Correspondences> scenes = {seen(kFour), seen({missed_by(1, 2, 16.0)})};
    auto stage = metric_of(scenes);
    stage.fire();
    auto other = metric_of<ReprojectionMetric>(scenes);
    other.fire();
    for (const char* scene : {"", "a", "b"})
        EXPECT_EQ(told_of(stage, "mean_px", scene),
                  told_of(other, "normalised_px", scene, "reprojection."));
    // The second scene's corner is the farthest of all: in total the first four count half.
    EXPECT_NEAR(*told_of(stage, "mean_px"), (31.75 / 2.0 + 3.0) / 10.0, 1e-12);
    EXPECT_EQ(told_of(stage, "largest_range"), 16.0);
    EXPECT_EQ(told_of(stage, "largest_range", "a"), 8.0);
}

TEST(NormalisedReprojectionMetric, CornersThatWereNotFoundAreBeyondTenPixels) {
    // Of two scenes with two boards of 16 corners, one board of one scene was found.
    const std::vector<PointPair> good(16, missed_by(0.5, 0.5, 4.0));
    auto stage = metric_of({seen(good), seen({})});
    stage.give<Truth>("truth", boards(2), "a").give<Truth>("truth", boards(2), "b");
    stage.fire();
    EXPECT_EQ(told_of(stage, "count"), 16.0);
    EXPECT_EQ(told_of(stage, "expected"), 64.0);
    EXPECT_DOUBLE_EQ(*told_of(stage, "below_10px_share"), 0.25);
    EXPECT_DOUBLE_EQ(*told_of(stage, "norm_below_1px_share"), 0.25);
    EXPECT_DOUBLE_EQ(*told_of(stage, "below_1px_share", "a"), 0.5);
    EXPECT_DOUBLE_EQ(*told_of(stage, "below_10px_share", "b"), 0.0);
    EXPECT_FALSE(told_of(stage, "mean_px", "b"));
    EXPECT_DOUBLE_EQ(*told_of(stage, "mean_px"), 0.5);
    EXPECT_TRUE(stage.notes().empty());

    // The parameter is for each camera too, and goes before the truth.
    stage.set("expected_corners", 32).fire();
    EXPECT_EQ(told_of(stage, "expected"), 64.0);
    stage.set("expected_corners", 16).fire();
    EXPECT_EQ(told_of(stage, "expected"), 32.0);
}

TEST(NormalisedReprojectionMetric, EveryCameraHasToFindThem) {
    Correspondences two = seen({missed_by(0.0, 0.0, 4.0)});
    two.cameras.push_back(seen({}, "REAR").cameras.front());
    auto stage = metric_of({two});
    stage.give<Truth>("truth", boards(1), "a").give<Truth>("truth", boards(1), "b");
    stage.set("expected_corners", 2).fire();
    EXPECT_EQ(told_of(stage, "expected", "a"), 4.0);
    EXPECT_DOUBLE_EQ(*told_of(stage, "below_1px_share", "a"), 0.25);
    EXPECT_EQ(told_of(stage, "expected", "b"), 2.0);  // no camera at all
}

TEST(NormalisedReprojectionMetric, PairsThatCannotBeMeasuredAreBeyondTenPixels) {
    // One behind the camera, and two of a camera that was not solved.
    Correspondences scene = seen({missed_by(0.1, 0.1, 4.0), missed_by(0.0, 0.0, -4.0)});
    scene.cameras.push_back(
        seen({missed_by(0, 0, 4.0), missed_by(0, 0, 4.0)}, "REAR").cameras.front());
    auto stage = metric_of({scene});
    stage.fire();
    EXPECT_EQ(told_of(stage, "count"), 1.0);
    EXPECT_EQ(told_of(stage, "expected"), 4.0);
    EXPECT_DOUBLE_EQ(*told_of(stage, "below_10px_share"), 0.25);
    ASSERT_EQ(stage.notes().size(), 2U);
    EXPECT_THAT(stage.notes()[0].nearest_miss, HasSubstr("1 measured, 1 do not project, 2 of"));
    EXPECT_THAT(stage.notes()[1].nearest_miss, HasSubstr("not known for 1 of 1 scenes"));
}

TEST(NormalisedReprojectionMetric, RealDataHaveNoTruth) {
    auto stage = metric_of({seen(kFour)});
    stage.give<Truth>("truth", Truth{}, "a").fire();
    EXPECT_EQ(told_of(stage, "expected"), 4.0);
    EXPECT_EQ(stage.notes().size(), 1U);

    auto nothing = metric_of({seen({})}, Extrinsics{});
    nothing.fire();
    EXPECT_EQ(told_of(nothing, "expected"), 0.0);
    EXPECT_FALSE(told_of(nothing, "below_10px_share"));
    EXPECT_EQ(nothing.notes().size(), 2U);
}

}  // namespace
}  // namespace petal
