// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "petal/error.hpp"
#include "petal/testing/stage_harness.hpp"
#include "plugins/solvers/made_rig.hpp"
#include "solvers/board_matcher.hpp"
#include "solvers/detail/order_chi2.hpp"

namespace petal {
namespace {

using ::testing::HasSubstr;
using testing::MadeRig;
using testing::Placement;
using testing::StageHarness;
using Scenes = std::vector<MadeRig::Seen>;

/// One board a scene, the LiDAR's corner order turned at will.
Scenes one_board_each(MadeRig& rig, const std::vector<Placement>& places) {
    Scenes scenes;
    for (const Placement& place : places) {
        scenes.push_back(rig.scene());
        rig.add(scenes.back(), place, true, true, static_cast<int>(rig.random()() % 4));
    }
    return scenes;
}

StageHarness matcher_of(const Scenes& scenes, bool priors) {
    auto stage = StageHarness::of<BoardMatcher>("solver.board_matcher");
    stage.set("upright", priors).set("use_max_baseline", priors);
    for (std::size_t i = 0; i < scenes.size(); ++i) {
        const std::string name = "place_" + std::to_string(i);
        stage.give<LidarBoards>("lidar", scenes[i].lidar, name);
        stage.give<ImageBoards>("image", scenes[i].image, name);
    }
    return stage;
}

std::vector<CameraPairs> match_jointly(const Scenes& scenes, bool priors = false) {
    auto stage = matcher_of(scenes, priors);
    stage.fire();
    return stage.out<Correspondences>("correspondences").cameras;
}

std::size_t boards_in(const std::vector<CameraPairs>& cameras) {
    std::size_t boards = 0;
    for (const CameraPairs& camera : cameras) boards += camera.boards.size();
    return boards;
}

TEST(JointOrder, DiversePlacementsAreDecidedByTheDataAndRight) {
    for (const auto& places : {testing::three_yaw(), testing::four_diverse()})
        for (unsigned seed = 1; seed <= 10; ++seed) {
            MadeRig rig(seed);
            const auto cameras = match_jointly(one_board_each(rig, places));
            ASSERT_EQ(cameras.size(), places.size());
            EXPECT_EQ(boards_in(cameras), places.size()) << "seed " << seed;
            EXPECT_TRUE(testing::order_is_right(cameras, rig.T_camera_lidar())) << "seed " << seed;
            for (std::size_t i = 0; i < cameras.size(); ++i) {
                EXPECT_EQ(cameras[i].scene, i);
                EXPECT_EQ(cameras[i].scene_name, "place_" + std::to_string(i));
                EXPECT_EQ(cameras[i].order.by, DecidedBy::data) << cameras[i].order.reason;
                EXPECT_EQ(cameras[i].order.reason, cameras[0].order.reason);
            }
        }
}

TEST(JointOrder, OneBoardWhereverItStandsIsNeverTheDatas) {
    // Also where the same placement is captured three times: nothing was added.
    for (unsigned seed = 1; seed <= 10; ++seed) {
        MadeRig rig(seed);
        EXPECT_EQ(match_jointly(one_board_each(rig, testing::one_flat())).at(0).order.by,
                  DecidedBy::undecided);
        auto scene = rig.scene();
        rig.add(scene, {{3.0, 0.3, 0.2}, 20.0, 10.0});
        const Scenes thrice(3, scene);
        EXPECT_EQ(match_jointly(thrice).at(0).order.by, DecidedBy::undecided);
        EXPECT_EQ(match_jointly(thrice, true).at(0).order.by, DecidedBy::prior);
    }
}

TEST(JointOrder, BoardsSideBySideAreNeverWrongByTheData) {
    int undecided = 0;
    for (unsigned seed = 1; seed <= 40; ++seed) {
        // Three times the noise of a good detector: the twin is in reach.
        MadeRig::Noise noise;
        noise.shift *= 3.0;
        noise.turn *= 3.0;
        noise.px *= 3.0;
        MadeRig rig(seed, noise);
        auto scene = rig.scene();
        for (const Placement& place : testing::two_beside())
            rig.add(scene, place, true, true, static_cast<int>(rig.random()() % 4));
        if (seed % 2 == 0) std::swap(scene.image.boards[0], scene.image.boards[1]);
        const auto cameras = match_jointly({scene});
        const OrderDecision& order = cameras.at(0).order;
        if (order.by == DecidedBy::data) {
            EXPECT_TRUE(testing::order_is_right(cameras, rig.T_camera_lidar())) << order.reason;
        } else {
            EXPECT_EQ(order.by, DecidedBy::undecided);
            EXPECT_THAT(order.reason, HasSubstr("2 boards swapped"));
            ++undecided;
        }
    }
    EXPECT_GT(undecided, 10);  // measured: 27
}

TEST(JointOrder, SevenBoardsInFourScenesAreMatchedWhateverTheirOrder) {
    for (unsigned seed = 1; seed <= 6; ++seed) {
        MadeRig rig(seed);
        auto places = testing::six_diverse();
        places.push_back({{3.4, 0.1, -0.6}, 5, -25, 10});
        Scenes scenes(4, rig.scene());
        for (std::size_t i = 0; i < places.size(); ++i) {
            const std::size_t place = (3 * i) % 7;  // neighbours in different scenes
            rig.add(scenes[i / 2], places[place], true, true, static_cast<int>(i % 4));
        }
        for (auto& scene : scenes)
            std::reverse(scene.image.boards.begin(), scene.image.boards.end());
        const auto cameras = match_jointly(scenes);
        EXPECT_EQ(boards_in(cameras), 7U);
        EXPECT_TRUE(testing::order_is_right(cameras, rig.T_camera_lidar()));
        EXPECT_EQ(cameras.at(0).order.by, DecidedBy::data) << cameras.at(0).order.reason;
    }
}

TEST(JointOrder, PostersAndBoardsOfOneSensorAreLeftOut) {
    MadeRig rig(5);
    Scenes scenes;
    const auto places = testing::four_diverse();
    for (std::size_t i = 0; i < places.size(); ++i) {
        scenes.push_back(rig.scene());
        rig.add(scenes.back(), places[i]);
        rig.add(scenes.back(), places[(i + 1) % 4], true, false);
        for (int poster = 0; poster < 5; ++poster)  // in the same places in all scenes
            rig.add(scenes.back(), {{4.6, 1.8 - 0.9 * poster, 1.0}, 5.0 * poster, 0.0}, false,
                    true);
    }
    const auto cameras = match_jointly(scenes);
    EXPECT_EQ(boards_in(cameras), 4U);
    for (const CameraPairs& camera : cameras) {
        ASSERT_EQ(camera.boards.size(), 1U);
        EXPECT_EQ(camera.boards[0].lidar, 0);
        EXPECT_EQ(camera.boards[0].image, 0);
        EXPECT_EQ(camera.pairs.front().board, 0);
    }
    EXPECT_EQ(cameras.at(0).order.by, DecidedBy::data) << cameras.at(0).order.reason;
}

TEST(JointOrder, ASceneWithoutABoardIsToldAndKeepsTheDecision) {
    MadeRig rig(2);
    auto scenes = one_board_each(rig, testing::four_diverse());
    scenes[1].image.boards.clear();
    scenes[2].lidar.boards.clear();
    auto stage = matcher_of(scenes, false);
    stage.fire();
    const auto& cameras = stage.out<Correspondences>("correspondences").cameras;
    ASSERT_EQ(cameras.size(), 4U);
    EXPECT_TRUE(cameras[1].pairs.empty());
    EXPECT_TRUE(cameras[2].pairs.empty());
    EXPECT_EQ(cameras[1].order.by, cameras[0].order.by);
    EXPECT_EQ(boards_in(cameras), 2U);
    EXPECT_TRUE(testing::order_is_right(cameras, rig.T_camera_lidar()));
    EXPECT_TRUE(stage.notes().empty()) << "nothing that both sensors see is missing";
}

TEST(JointOrder, CamerasAreDecidedApart) {
    // The second camera sees one board only: its order is not the data's, whatever the first sees.
    MadeRig rig(3);
    auto scenes = one_board_each(rig, testing::four_diverse());
    for (auto& scene : scenes) scene.image.cameras.push_back({"SIDE", rig.camera()});
    ImageBoard side = scenes[0].image.boards[0];
    side.camera = "SIDE";
    scenes[0].image.boards.insert(scenes[0].image.boards.begin(), side);
    const auto cameras = match_jointly(scenes, true);
    ASSERT_EQ(cameras.size(), 8U);
    for (const CameraPairs& camera : cameras)
        EXPECT_EQ(camera.order.by, camera.camera == "SIDE" ? DecidedBy::prior : DecidedBy::data);
    EXPECT_EQ(cameras[0].boards.at(0).image, 1);
    EXPECT_EQ(cameras[1].boards.at(0).image, 0);
}

TEST(JointOrder, TargetsAreNotMixed) {
    MadeRig rig(4);
    auto scene = rig.scene();
    for (const Placement& place : testing::three_yaw()) rig.add(scene, place);
    scene.lidar.boards[0].target = scene.image.boards[0].target = "another";
    scene.lidar.boards[1].target = "a third";
    const auto cameras = match_jointly({scene});
    ASSERT_EQ(cameras.at(0).boards.size(), 2U);
    for (const auto& board : cameras[0].boards) {
        EXPECT_EQ(board.lidar, board.image);
        EXPECT_NE(board.lidar, 1);
    }
}

TEST(JointOrder, OtherIntrinsicsInASceneAreRefused) {
    MadeRig rig(1);
    auto scenes = one_board_each(rig, testing::three_yaw());
    scenes[2].image.cameras[0].camera.fx(930.0);
    try {
        match_jointly(scenes);
        FAIL() << "matched";
    } catch (const Error& e) {
        EXPECT_THAT(e.what(), HasSubstr("place_2"));
    }
}

TEST(JointOrder, TooLittleNoiseToldDoesNotUndoAnOrderThatNothingComesNear) {
    MadeRig::Noise noise;
    noise.shift *= 3.0;
    noise.turn *= 3.0;
    noise.px *= 3.0;
    noise.told = 1.0 / 3.0;
    MadeRig rig(1, noise);
    const auto cameras = match_jointly(one_board_each(rig, testing::four_diverse()));
    EXPECT_EQ(cameras.at(0).order.by, DecidedBy::data);
    EXPECT_THAT(cameras[0].order.reason, HasSubstr("more than noise"));
}

TEST(JointOrder, BoardPairsHaveTheCamerasOrder) {
    MadeRig rig(7);
    const auto scenes = one_board_each(rig, testing::four_diverse());
    const auto cameras = match_jointly(scenes);
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

TEST(JointOrder, WithoutAJointCovarianceTheCornersOwnIsTold) {
    MadeRig rig(7);
    auto scenes = one_board_each(rig, testing::three_yaw());
    for (auto& scene : scenes) {
        scene.image.boards[0].joint_covariance.resize(0, 0);
        scene.lidar.boards[0].covariance.reset();
    }
    scenes[0].image.boards[0].covariance[3] << 2.0, 0.5, 0.5, 1.0;
    const auto cameras = match_jointly(scenes);
    const CameraPairs::BoardPair& pair = cameras.at(0).boards.at(0);
    EXPECT_FALSE(pair.pose_covariance);
    ASSERT_EQ(pair.image_covariance.rows(), 32);
    EXPECT_EQ(pair.image_covariance(6, 7), 0.5);
    EXPECT_EQ(pair.image_covariance(6, 6), 2.0);
    EXPECT_EQ(pair.image_covariance(6, 8), 0.0);
}

TEST(JointOrder, ChiSquareIsThatOfItsDegreesOfFreedom) {
    // 200 sets of four boards have a mean of 18 with a standard error of 0.42; bound: four of them.
    double sum = 0.0;
    constexpr int kSets = 200;
    for (unsigned seed = 1; seed <= kSets; ++seed) {
        MadeRig rig(seed);
        const CameraModel model(rig.camera());
        BoardSet boards(model, GateParams{});
        Scenes scenes;
        for (const Placement& place : testing::four_diverse()) {
            scenes.push_back(rig.scene());
            rig.add(scenes.back(), place);
        }
        std::vector<BoardMatch> matches;
        for (const auto& scene : scenes) {
            matches.push_back({static_cast<int>(matches.size()), static_cast<int>(matches.size())});
            boards.add_scene(&scene.lidar, scene.image, {0});
        }
        const OrderChi2 chi2 = order_chi2(boards, matches, rig.T_camera_lidar(), 0.005);
        EXPECT_EQ(chi2.degrees_of_freedom, 18);
        sum += chi2.chi2;
    }
    EXPECT_NEAR(sum / kSets, 18.0, 1.7);
}

}  // namespace
}  // namespace petal
