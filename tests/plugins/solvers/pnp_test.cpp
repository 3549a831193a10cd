// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "solvers/pnp.hpp"

#include <gtest/gtest.h>

#include "petal/calibration/angles.hpp"
#include "petal/calibration/se3.hpp"
#include "petal/error.hpp"
#include "petal/testing/stage_harness.hpp"
#include "plugins/solvers/real_pairs.hpp"
#include "real_data.hpp"

namespace petal {
namespace {

using testing::StageHarness;

Correspondences scene_of(std::vector<PointPair> pairs) {
    CameraPairs seen;
    seen.camera = "CAMERA";
    seen.lidar = "LIDAR";
    seen.model = testing::indoor_camera();
    seen.pairs = std::move(pairs);
    seen.order.by = DecidedBy::given;
    return Correspondences{{seen}};
}

class EveryMethod : public ::testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Pnp, EveryMethod, ::testing::Values("sqpnp", "epnp", "iterative"));

TEST_P(EveryMethod, LiesNearThePublishedPose) {
    PETAL_NEEDS_REAL_DATA();
    const auto data = testing::real_data();
    auto stage = StageHarness::of<Pnp>("solver.pnp");
    stage.set("method", GetParam())
        .give<Correspondences>("correspondences", scene_of(testing::indoor_pairs(data)));
    stage.fire();
    const auto& camera = stage.out<Extrinsics>("extrinsics").cameras.at(0);
    const auto published = testing::published_pose(data / "sjtu_indoor/published_extrinsic.txt");
    // Other costs on the same noise: within about twice the 1-sigma of the least squares.
    EXPECT_LT(
        kDegrees * rotation_angle(camera.T_camera_lidar.linear() * published.linear().transpose()),
        0.5);
    EXPECT_LT((camera.T_camera_lidar.translation() - published.translation()).norm(), 0.03);
    EXPECT_EQ(stage.verdict(), Level::weak);
    EXPECT_EQ(camera.residuals.size(), 64u);
    EXPECT_GT(camera.sigma_translation.minCoeff(), 0.0);
}

TEST(Pnp, IppeTakesOnePlaneOnly) {
    PETAL_NEEDS_REAL_DATA();
    const auto pairs = testing::indoor_pairs(testing::real_data());
    auto whole = StageHarness::of<Pnp>();
    whole.set("method", "ippe").give<Correspondences>("correspondences", scene_of(pairs));
    whole.fire();
    EXPECT_EQ(whole.verdict(), Level::not_usable);
    EXPECT_EQ(whole.notes().size(), 1u);

    auto board = StageHarness::of<Pnp>();
    board.set("method", "ippe")
        .give<Correspondences>("correspondences", scene_of(testing::board_in_rows(pairs, 0)));
    board.fire();
    EXPECT_EQ(board.out<Extrinsics>("extrinsics").cameras.size(), 1u);
}

TEST(Pnp, AnUnknownMethodIsRefused) {
    EXPECT_THROW(StageHarness::of<Pnp>().set("method", "ransac"), Error);
}

}  // namespace
}  // namespace petal
