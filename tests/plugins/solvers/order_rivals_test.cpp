// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "solvers/detail/order_rivals.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "petal/calibration/angles.hpp"
#include "plugins/solvers/joint_match.hpp"
#include "plugins/solvers/made_rig.hpp"
#include "solvers/detail/order_choice.hpp"

namespace petal {
namespace {

/// An order as the search would tell it, at the true pose.
BoardOrder told_order(std::vector<BoardMatch> matches, const Eigen::Isometry3d& pose,
                      double rms_px) {
    BoardOrder order;
    order.matches = std::move(matches);
    RefinedPose refined;
    refined.T_camera_lidar = pose;
    refined.rms_px = rms_px;
    order.poses.push_back(refined);
    order.worst_gate_ratio = 0.5;
    order.within_gate = order.matches.size();
    return order;
}

TEST(OrderRivals, TheLeastChiSquareOfAllRivalsCountsNotThatOfTheLeastRms) {
    testing::MadeRig rig(3);
    testing::Scenes scenes;
    for (const testing::Placement& place : testing::four_diverse()) {
        scenes.push_back(rig.scene());
        rig.add(scenes.back(), place);
    }
    // Of the last board the LiDAR knows next to nothing: turned in its plane it explains as much.
    *scenes[3].lidar.boards[0].covariance *= 1e8;
    const CameraModel model(rig.camera());
    BoardSet boards(model, GateParams{});
    std::vector<BoardMatch> right;
    for (const auto& scene : scenes) {
        right.push_back({static_cast<int>(right.size()), static_cast<int>(right.size())});
        boards.add_scene(&scene.lidar, scene.image, {0});
    }
    auto nearer = right, unsure = right;
    nearer[0].rotation = 1;
    unsure[3].rotation = 1;
    OrderParams params;
    params.upright = params.use_max_baseline = false;
    const Eigen::Isometry3d& pose = rig.T_camera_lidar();
    const BoardOrders orders(boards);
    const auto choice = choose_order(orders,
                                     {told_order(right, pose, 0.3), told_order(nearer, pose, 2.0),
                                      told_order(unsure, pose, 2.5)},
                                     params);
    ASSERT_TRUE(choice.has_value());
    EXPECT_EQ(choice->order.matches, right);
    EXPECT_EQ(choice->decision.by, DecidedBy::undecided) << choice->decision.reason;
    EXPECT_LT(choice->decision.runner_up_chi2, params.min_runner_up_chi2);
    EXPECT_THAT(choice->decision.reason, ::testing::HasSubstr("chi-square only"));
    // Without it the data decide.
    EXPECT_EQ(
        choose_order(orders, {told_order(right, pose, 0.3), told_order(nearer, pose, 2.0)}, params)
            ->decision.by,
        DecidedBy::data);
}

TEST(OrderRivals, RotationsOfAllBoardsTurnTheSameWayAboutTheirZ) {
    // The plane's own axes are of either hand for a square board, as its noise has it.
    for (unsigned seed = 1; seed <= 20; ++seed) {
        testing::MadeRig rig(seed);
        const auto scenes = testing::one_board_each(rig, testing::four_diverse());
        const CameraModel model(rig.camera());
        BoardSet boards(model, GateParams{});
        for (const auto& scene : scenes) boards.add_scene(&scene.lidar, scene.image, {0});
        for (const BoardSet::FromLidar& seen : boards.lidar()) {
            ASSERT_EQ(seen.turns.size(), 4U);
            for (std::size_t r = 0; r < 4; ++r) {
                const Eigen::Matrix3d axes = seen.board->T_lidar_board.linear();
                const Eigen::Matrix3d turn = axes.transpose() * seen.turns[r].linear() * axes;
                const Eigen::Matrix3d expected =
                    Eigen::AngleAxisd(0.5 * kPi * static_cast<double>(r), Eigen::Vector3d::UnitZ())
                        .toRotationMatrix();
                EXPECT_LT((turn - expected).norm(), 1e-9) << "seed " << seed << ", rotation " << r;
            }
        }
    }
}

}  // namespace
}  // namespace petal
