// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "solvers/detail/matched_pairs.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "plugins/solvers/joint_match.hpp"
#include "plugins/solvers/made_rig.hpp"
#include "solvers/detail/order_chi2.hpp"

namespace petal {
namespace {

TEST(MatchedPairs, BoardPairsHaveTheCamerasOrder) {
    testing::MadeRig rig(7);
    const auto scenes = testing::one_board_each(rig, testing::four_diverse());
    const auto cameras = testing::match_jointly(scenes);
    for (std::size_t s = 0; s < scenes.size(); ++s) {
        ASSERT_EQ(cameras.at(s).boards.size(), 1U);
        const CameraPairs::BoardPair& pair = cameras[s].boards[0];
        ASSERT_EQ(pair.corners_board.size(), 16U);
        const LidarBoard& lidar = scenes[s].lidar.boards[0];
        EXPECT_EQ(*pair.pose_covariance, *lidar.covariance);
        for (std::size_t i = 0; i < 16; ++i) {
            // Of the target, row by row, to rounding.
            const Eigen::Vector3d target(0.1 * static_cast<double>(1 + i % 4),
                                         0.1 * static_cast<double>(1 + i / 4), 0.0);
            EXPECT_LT((pair.corners_board[i] - target).norm(), 1e-9);
            EXPECT_LT((pair.T_lidar_board * target - cameras[s].pairs[i].lidar).norm(), 1e-9);
            EXPECT_EQ(pair.corners_image[i], scenes[s].image.boards[0].corners[i]);
        }
        // Turned in its plane about its centre, so this and the normal stay.
        const Eigen::Vector3d centre(0.25, 0.25, 0.0);
        EXPECT_LT((pair.T_lidar_board * centre - lidar.T_lidar_board * centre).norm(), 1e-9);
        EXPECT_GT(pair.T_lidar_board.linear().col(2).dot(lidar.T_lidar_board.linear().col(2)),
                  1.0 - 1e-9);
        EXPECT_EQ(pair.image_covariance, scenes[s].image.boards[0].joint_covariance);
    }
}

TEST(MatchedPairs, WithoutAJointCovarianceTheCornersCountAQuarterEach) {
    testing::MadeRig rig(7);
    auto scenes = testing::one_board_each(rig, testing::three_yaw());
    for (auto& scene : scenes) {
        scene.image.boards[0].joint_covariance.resize(0, 0);
        scene.lidar.boards[0].covariance.reset();
    }
    scenes[0].image.boards[0].covariance[3] << 2.0, 0.5, 0.5, 1.0;
    const auto cameras = testing::match_jointly(scenes);
    const CameraPairs::BoardPair& pair = cameras.at(0).boards.at(0);
    EXPECT_FALSE(pair.pose_covariance);
    ASSERT_EQ(pair.image_covariance.rows(), 32);
    // Corners cut from about eight lines are not independent: four times their own covariance.
    EXPECT_EQ(pair.image_covariance(6, 7), 2.0);
    EXPECT_EQ(pair.image_covariance(6, 6), 8.0);
    EXPECT_EQ(pair.image_covariance(6, 8), 0.0);
}

TEST(OrderChi2, IsThatOfItsDegreesOfFreedom) {
    // 200 sets of four boards have a mean of 18 with a standard error of 0.42; bound: four of them.
    double sum = 0.0;
    constexpr int kSets = 200;
    for (unsigned seed = 1; seed <= kSets; ++seed) {
        testing::MadeRig rig(seed);
        const CameraModel model(rig.camera());
        BoardSet boards(model, GateParams{});
        testing::Scenes scenes;
        for (const testing::Placement& place : testing::four_diverse()) {
            scenes.push_back(rig.scene());
            rig.add(scenes.back(), place);
        }
        std::vector<BoardMatch> matches;
        for (const auto& scene : scenes) {
            matches.push_back({static_cast<int>(matches.size()), static_cast<int>(matches.size())});
            boards.add_scene(&scene.lidar, scene.image, {0});
        }
        const auto chi2 = order_chi2(boards, matches, rig.T_camera_lidar(), 0.005);
        ASSERT_TRUE(chi2.has_value());
        EXPECT_EQ(chi2->degrees_of_freedom, 18);
        sum += chi2->chi2;
    }
    EXPECT_NEAR(sum / kSets, 18.0, 1.7);
}

TEST(OrderChi2, WhatCannotBeToldIsNoPerfectFit) {
    testing::MadeRig rig(1);
    const CameraModel model(rig.camera());
    auto scenes = testing::one_board_each(rig, testing::three_yaw());
    const auto chi2_at = [&](const Eigen::Isometry3d& pose) {
        BoardSet boards(model, GateParams{});
        std::vector<BoardMatch> matches;
        for (const auto& scene : scenes) {
            matches.push_back({static_cast<int>(matches.size()), static_cast<int>(matches.size())});
            boards.add_scene(&scene.lidar, scene.image, {0});
        }
        return order_chi2(boards, matches, pose, 0.005);
    };
    EXPECT_TRUE(chi2_at(rig.T_camera_lidar()).has_value());
    Eigen::Isometry3d behind = rig.T_camera_lidar();
    behind.pretranslate(Eigen::Vector3d(0.0, 0.0, -20.0));
    EXPECT_FALSE(chi2_at(behind).has_value());
    const auto good = scenes;
    scenes[1].image.boards[0].joint_covariance *= -1.0;
    EXPECT_FALSE(chi2_at(rig.T_camera_lidar()).has_value());
    scenes = good;
    scenes[1].image.boards[0].joint_covariance(3, 3) = std::numeric_limits<double>::quiet_NaN();
    EXPECT_FALSE(chi2_at(rig.T_camera_lidar()).has_value());
    scenes = good;
    *scenes[1].lidar.boards[0].covariance *= -1.0;
    EXPECT_FALSE(chi2_at(rig.T_camera_lidar()).has_value());
}

}  // namespace
}  // namespace petal
