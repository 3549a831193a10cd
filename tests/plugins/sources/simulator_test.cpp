// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "sources/simulator.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "petal/calibration/camera_model.hpp"
#include "petal/calibration/cloud.hpp"
#include "petal/calibration/images.hpp"
#include "petal/calibration/truth.hpp"
#include "petal/error.hpp"
#include "petal/testing/stage_harness.hpp"

namespace petal {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::StageHarness;

const std::string kSmallScene = PETAL_SOURCE_DIR "/tests/data/small_scene.json";

StageHarness small_simulator(std::uint64_t seed = 1) {
    StageHarness stage = StageHarness::of<SimulatorSource>();
    stage.set("scenes", Value(std::vector<std::string>{kSmallScene})).seed(seed);
    return stage;
}

/// Everything that the scenes hold, as text: equal where they are.
std::string content_of_scenes(const StageHarness& stage) {
    std::string bytes;
    const auto add = [&](const void* data, std::size_t size) {
        bytes.append(static_cast<const char*>(data), size);
    };
    for (const auto& cloud : stage.all<Cloud>("cloud"))
        for (const auto* values :
             {&cloud->points->getPointsBufferRef_x(), &cloud->points->getPointsBufferRef_y(),
              &cloud->points->getPointsBufferRef_z()})
            add(values->data(), values->size() * sizeof(float));
    for (const auto& images : stage.all<Images>("images"))
        for (const auto* list : {&images->cameras, &images->others})
            for (const CameraImage& image : *list) {
                const cv::Mat pixels = image.image.asCvMat<cv::Mat>(mrpt::img::SHALLOW_COPY);
                add(pixels.data, pixels.total() * pixels.elemSize());
            }
    for (const auto& truth : stage.all<Truth>("truth")) {
        add(truth->labels.data(), truth->labels.size());
        add(truth->T_camera_lidar->matrix().data(), 16 * sizeof(double));
        for (const Truth::Board& board : truth->boards)
            add(board.T_lidar_board.matrix().data(), 16 * sizeof(double));
    }
    return bytes;
}

TEST(SimulatorStage, ASceneIsWhatARecorderWouldWrite) {
    StageHarness stage = small_simulator();
    stage.fire();
    const auto clouds = stage.all<Cloud>("cloud");
    const auto images = stage.all<Images>("images");
    ASSERT_EQ(clouds.size(), 2U);
    EXPECT_EQ(clouds[0].frame.name, "small_scene_near");
    EXPECT_EQ(clouds[1].frame.name, "small_scene_far");
    EXPECT_LT(clouds[0].frame.stamp + 10.0, clouds[1].frame.stamp);
    for (std::size_t k = 0; k < 2; ++k) {
        const Cloud& cloud = *clouds[k];
        ASSERT_EQ(cloud.parts.size(), 3U) << "messages of 0.1 s";
        EXPECT_EQ(cloud.sensor_label, "LIDAR");
        for (std::size_t i = 0; i < 3; ++i)
            EXPECT_NEAR(mrpt::Clock::toDouble(cloud.parts[i].stamp),
                        clouds[k].frame.stamp + 0.1 * static_cast<double>(i), 1e-6);
        EXPECT_LE(cloud.size(), 30000U) << "100 k pulses a second";
        EXPECT_GT(cloud.size(), 15000U);
        ASSERT_EQ(images[k]->cameras.size(), 1U);
        ASSERT_EQ(images[k]->others.size(), 2U);
        const CameraImage& image = images[k]->cameras[0];
        EXPECT_EQ(image.camera.ncols, 320U);
        EXPECT_EQ(image.image.getWidth(), 320U);
        EXPECT_EQ(image.image.getHeight(), 240U);
        EXPECT_LT(images[k]->others[0].stamp, images[k]->others[1].stamp);
    }
}

TEST(SimulatorStage, TheTruthIsThatOfPointsAndPixels) {
    StageHarness stage = small_simulator();
    stage.fire();
    const auto clouds = stage.all<Cloud>("cloud");
    const auto truths = stage.all<Truth>("truth");
    const auto images = stage.all<Images>("images");
    for (std::size_t k = 0; k < 2; ++k) {
        const Truth& truth = *truths[k];
        ASSERT_EQ(truth.labels.size(), clouds[k]->size());
        ASSERT_EQ(truth.boards.size(), 1U);
        const Truth::Board& board = truth.boards[0];
        ASSERT_EQ(board.corners_lidar.size(), 16U);
        ASSERT_EQ(board.corners_image.size(), 16U);
        const CameraModel model(images[k]->cameras[0].camera);
        for (std::size_t i = 0; i < 16; ++i)
            EXPECT_TRUE(model.project(*truth.T_camera_lidar * board.corners_lidar[i])
                            ->isApprox(board.corners_image[i]));
        // Points of the board lie on its front, but for noise (12 mm), the device's offset (5 mm),
        // and the few that met the wall of a hole or are partial echoes (at most 2 cm off by their
        // label).
        double sum = 0.0;
        int count = 0;
        for (std::size_t i = 0; i < truth.labels.size(); ++i) {
            if (truth.labels[i] != 1) continue;
            mrpt::math::TPoint3Df p;
            clouds[k]->points->getPoint(i, p.x, p.y, p.z);
            const Eigen::Vector3d on_board =
                board.T_lidar_board.inverse() * Eigen::Vector3d(p.x, p.y, p.z);
            ASSERT_LT(std::abs(on_board.z()), 0.12) << "eight sigma and the label's 2 cm";
            sum += on_board.z();
            ++count;
        }
        ASSERT_GT(count, 500);
        EXPECT_LT(std::abs(sum / count), 0.02) << "four sigma of the offset";
    }
}

TEST(SimulatorStage, TheSameSeedGivesTheSameBytesOnAnyNumberOfThreads) {
    std::string first;
    for (const int threads : {1, 2, 5}) {
        StageHarness stage = small_simulator(7);
        stage.threads(threads).fire();
        const std::string bytes = content_of_scenes(stage);
        if (first.empty()) first = bytes;
        EXPECT_TRUE(bytes == first) << threads << " threads";
    }
    StageHarness other = small_simulator(8);
    other.fire();
    EXPECT_FALSE(content_of_scenes(other) == first);
}

TEST(SimulatorStage, ScenesShareARigOnRequest) {
    const auto rigs = [](StageHarness stage) {
        stage.fire();
        std::vector<Eigen::Isometry3d> poses;
        for (const auto& truth : stage.all<Truth>("truth")) poses.push_back(*truth->T_camera_lidar);
        return poses;
    };
    const auto shared = rigs(small_simulator(1));
    EXPECT_TRUE(shared[0].isApprox(shared[1], 0.0));
    const auto each = rigs(std::move(small_simulator(1).set("rig", "each")));
    EXPECT_TRUE(each[0].isApprox(shared[0], 0.0));
    EXPECT_FALSE(each[1].isApprox(shared[0], 1e-6));
    // Other seeds, one rig: boards and noise differ.
    const auto first = rigs(std::move(small_simulator(1).set("rig_seed", 5)));
    const auto second = rigs(std::move(small_simulator(2).set("rig_seed", 5)));
    EXPECT_TRUE(first[0].isApprox(second[0], 0.0));
    EXPECT_FALSE(first[0].isApprox(shared[0], 1e-6));
    EXPECT_THROW(rigs(std::move(small_simulator(1).set("rig_seed", 5).set("rig", "each"))), Error);
}

TEST(SimulatorStage, DurationImageAndLidarCanBeChosen) {
    StageHarness stage = small_simulator();
    stage.set("duration", 0.1).set("image_choice", "last").set("lidar", "livox_avia").fire();
    const auto cloud = stage.all<Cloud>("cloud").front();
    EXPECT_EQ(cloud->parts.size(), 1U);
    EXPECT_GT(cloud->size(), 15000U) << "240 k pulses a second";
    const auto images = stage.all<Images>("images").front();
    EXPECT_LT(images->others.back().stamp, images->cameras.front().stamp);
}

TEST(SimulatorStage, TheFilesAreTold) {
    StageHarness stage = small_simulator();
    stage.fire();
    std::vector<std::string> names;
    for (const auto& file : stage.used_files()) names.push_back(file.filename().string());
    EXPECT_THAT(names, ::testing::IsSupersetOf({"small_scene.json", "four_square_holes_500mm.json",
                                                "livox_mid70.json"}));
}

TEST(SimulatorStage, AnUnknownSceneListsTheKnown) {
    StageHarness stage = StageHarness::of<SimulatorSource>();
    stage.set("scenes", Value(std::vector<std::string>{"indoor_flor_3m"}));
    try {
        stage.fire();
        FAIL() << "no error";
    } catch (const Error& error) {
        EXPECT_THAT(error.what(), HasSubstr("indoor_flor_3m"));
        EXPECT_THAT(error.what(), HasSubstr("indoor_floor_3m"));
    }
    EXPECT_THROW(
        StageHarness::of<SimulatorSource>().set("scenes", Value(std::vector<std::string>{})).fire(),
        Error);
}

TEST(SimulatorStage, ACancelIsObeyed) {
    StageHarness stage = small_simulator();
    stage.set("duration", 600.0).cancel_after(0.05);
    EXPECT_THROW(stage.fire(), Cancelled);
}

}  // namespace
}  // namespace petal
