// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "sinks/colored_cloud.hpp"

#include <gmock/gmock.h>
#include <mrpt/opengl/COpenGLScene.h>
#include <mrpt/opengl/CPointCloudColoured.h>

#include <cstring>
#include <fstream>
#include <iterator>

#include "petal/testing/stage_harness.hpp"
#include "plugins/sinks/judged_example.hpp"

namespace petal {
namespace {

using ::testing::HasSubstr;
using testing::StageHarness;
namespace fs = std::filesystem;

struct PlyPoint {
    float x, y, z;
    int red, green, blue;
};

std::vector<PlyPoint> read_ply(const fs::path& file) {
    std::ifstream in(file, std::ios::binary);
    const std::string text{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
    const std::size_t begin = text.find("end_header\n") + 11;
    EXPECT_EQ((text.size() - begin) % 15, 0u);
    std::vector<PlyPoint> points;
    for (std::size_t at = begin; at + 15 <= text.size(); at += 15) {
        float place[3];
        std::memcpy(place, &text[at], sizeof place);
        const auto byte = [&](std::size_t i) {
            return static_cast<int>(static_cast<unsigned char>(text[at + 12 + i]));
        };
        points.push_back({place[0], place[1], place[2], byte(0), byte(1), byte(2)});
    }
    EXPECT_THAT(text.substr(0, begin),
                HasSubstr("element vertex " + std::to_string(points.size()) + "\n"));
    return points;
}

TEST(ColoredCloudTest, PointsTakeTheColourOfTheirPixelUnlessHidden) {
    StageHarness stage = judged_example::stage<ColoredCloud>();
    stage.set("cell_px", 8).fire();
    const auto points = read_ply(stage.folder() / "colored_cloud" / "hall.ply");
    ASSERT_EQ(points.size(), 5u);  // the one that is no number has no place
    const auto expect_colour = [&](std::size_t i, int red, int green, int blue) {
        EXPECT_EQ(points[i].red, red) << i;
        EXPECT_EQ(points[i].green, green) << i;
        EXPECT_EQ(points[i].blue, blue) << i;
    };
    expect_colour(0, 255, 0, 0);      // on the left half
    expect_colour(1, 0, 0, 255);      // on the right half
    expect_colour(2, 110, 110, 110);  // behind the first one
    expect_colour(3, 110, 110, 110);  // beside the photo
    expect_colour(4, 110, 110, 110);  // behind the camera
    EXPECT_EQ(points[0].x, 2.0F);     // in the LiDAR's frame, as it came
    EXPECT_EQ(points[2].x, 6.0F);
}

TEST(ColoredCloudTest, WhatNoCameraSeesMayBeLeftOut) {
    StageHarness stage = judged_example::stage<ColoredCloud>();
    stage.set("uncolored", "drop").set("cell_px", 8).fire();
    EXPECT_EQ(read_ply(stage.folder() / "colored_cloud" / "hall.ply").size(), 2u);
}

TEST(ColoredCloudTest, MrptReadsTheScene) {
    StageHarness stage = judged_example::stage<ColoredCloud>();
    stage.set("formats", std::vector<std::string>{"3Dscene"}).set("cell_px", 8).fire();
    EXPECT_FALSE(fs::exists(stage.folder() / "colored_cloud" / "hall.ply"));
    mrpt::opengl::COpenGLScene scene;
    ASSERT_TRUE(scene.loadFromFile((stage.folder() / "colored_cloud" / "hall.3Dscene").string()));
    const auto cloud = scene.getByClass<mrpt::opengl::CPointCloudColoured>();
    ASSERT_TRUE(cloud);
    EXPECT_EQ(cloud->size(), 5u);
    std::uint8_t red = 0, green = 0, blue = 0;
    cloud->getPointColor_fast(1, red, green, blue);
    EXPECT_EQ(red, 0);
    EXPECT_EQ(blue, 255);
    // The camera stands where T_lidar_camera says.
    const auto camera = scene.getByName("CAMERA");
    ASSERT_TRUE(camera);
    EXPECT_NEAR(camera->getPoseX(), 0.1, 1e-6);
    EXPECT_TRUE(scene.getByName("LIDAR"));
}

TEST(ColoredCloudTest, WithoutAPoseNothingIsWritten) {
    StageHarness stage = StageHarness::of<ColoredCloud>();
    judged_example::give(stage, Extrinsics{});
    stage.fire();
    EXPECT_EQ(stage.notes().size(), 1u);
    EXPECT_FALSE(fs::exists(stage.folder() / "colored_cloud"));
}

}  // namespace
}  // namespace petal
