// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "sinks/detail/point_colours.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "petal/testing/stage_harness.hpp"

namespace petal {
namespace {

using testing::StageHarness;

/// Left half red, right half blue; f = 100 px, centre (50, 40); camera and LiDAR frames are one.
CameraImage two_halves() {
    cv::Mat photo(80, 100, CV_8UC3, cv::Scalar(0, 0, 255));
    photo.colRange(50, 100) = cv::Scalar(255, 0, 0);
    CameraImage image;
    image.image = mrpt::img::CImage(photo, mrpt::img::DEEP_COPY);
    image.camera.ncols = 100;
    image.camera.nrows = 80;
    image.camera.setIntrinsicParamsFromValues(100.0, 100.0, 50.0, 40.0);
    return image;
}

/// Runs what needs a Run.
struct CallStage final : Stage {
    struct Params {};
    static void describe(Spec<Params>& s) { s.gathers<Cloud>("cloud", "points"); }
    explicit CallStage(Params) {}
    void finish(Run& run) override { work(run, *run.all<Cloud>("cloud").front()); }
    static inline std::function<void(const Run&, const Cloud&)> work;
};

void with_points(const std::vector<Eigen::Vector3f>& points,
                 const std::function<void(const Run&, const Cloud&)>& work) {
    auto map = std::make_shared<mrpt::maps::CPointsMapXYZI>();
    for (const auto& p : points) map->insertPointFast(p.x(), p.y(), p.z());
    Cloud cloud;
    cloud.points = map;
    CallStage::work = work;
    StageHarness stage = StageHarness::of<CallStage>();
    stage.give<Cloud>("cloud", cloud);
    stage.fire();
}

TEST(PointColoursTest, AreThoseOfThePixelsThatPointsProjectTo) {
    with_points({{-0.1F, 0.0F, 1.0F},
                 {0.1F, 0.0F, 1.0F},
                 {0.0F, 0.0F, -1.0F},
                 {9.0F, 0.0F, 1.0F},
                 {std::nanf(""), 0.0F, 1.0F}},
                [](const petal::Run& run, const Cloud& cloud) {
                    const CameraImage image = two_halves();
                    const PointColours colours(run, cloud, image, Eigen::Isometry3d::Identity());
                    ASSERT_TRUE(colours.of(0) && colours.of(1));
                    EXPECT_EQ(colours.of(0)->red, 255);
                    EXPECT_EQ(colours.of(0)->blue, 0);
                    EXPECT_EQ(colours.of(1)->blue, 255);
                    for (const std::size_t outside : {2U, 3U, 4U}) {
                        EXPECT_FALSE(colours.of(outside)) << outside;
                        EXPECT_FALSE(colours.hidden(outside)) << outside;
                    }
                });
}

TEST(PointColoursTest, WhatLiesBehindANearSurfaceGetsNone) {
    // A plate of 0.2 x 0.2 m at 1 m (pixels 40 to 60), a point each 0.01 m; two points behind it,
    // one of them through a pixel beside the plate.
    std::vector<Eigen::Vector3f> points;
    for (int x = -10; x <= 10; ++x)
        for (int y = -10; y <= 10; ++y)
            points.emplace_back(0.01F * static_cast<float>(x), 0.01F * static_cast<float>(y), 1.0F);
    const std::size_t plate = points.size();
    points.emplace_back(0.015F, 0.015F, 3.0F);
    points.emplace_back(-0.9F, 0.0F, 3.0F);  // pixel 20
    points.emplace_back(0.0F, 0.0F, 1.05F);  // nearer behind the plate than the slack of 0.1 m
    with_points(points, [&](const petal::Run& run, const Cloud& cloud) {
        const CameraImage image = two_halves();
        const PointColours colours(run, cloud, image, Eigen::Isometry3d::Identity());
        EXPECT_EQ(colours.cell_px(), 4) << "16 points of the plate lie in a cell of 4 px";
        for (std::size_t i = 0; i < plate; ++i) EXPECT_TRUE(colours.of(i)) << i;
        EXPECT_TRUE(colours.hidden(plate));
        EXPECT_FALSE(colours.of(plate));
        EXPECT_TRUE(colours.of(plate + 1));
        EXPECT_TRUE(colours.of(plate + 2));
    });
}

TEST(PointColoursTest, OfSomePointsTheseAloneHideEachOther) {
    with_points({{-0.1F, 0.0F, 1.0F}, {0.1F, 0.0F, 1.0F}, {0.3F, 0.0F, 3.0F}, {9.0F, 0.0F, 1.0F}},
                [](const petal::Run& run, const Cloud& cloud) {
                    const CameraImage image = two_halves();
                    const auto pose = Eigen::Isometry3d::Identity();
                    Occlusion fine;
                    fine.cell_px = 4;
                    EXPECT_TRUE(PointColours(run, cloud, image, pose, fine).hidden(2));
                    const PointColours without(run, cloud, {0, 2, 3}, image, pose, fine);
                    ASSERT_TRUE(without.of(0) && without.of(1));
                    EXPECT_EQ(without.of(0)->red, 255);
                    EXPECT_EQ(without.of(1)->blue, 255);
                    EXPECT_FALSE(without.of(2));
                    const PointColours with(run, cloud, {1, 2}, image, pose, fine);
                    EXPECT_TRUE(with.of(0));
                    EXPECT_TRUE(with.hidden(1));
                });
}

TEST(PointColoursTest, CellsGrowWhereAPlateHasFewPoints) {
    // A point each 0.1 m at 1 m is one each 10 px: cells of 4 px would let through what lies
    // between them.
    std::vector<Eigen::Vector3f> points;
    for (int x = -4; x <= 4; ++x)
        for (int y = -3; y <= 3; ++y)
            points.emplace_back(0.1F * static_cast<float>(x), 0.1F * static_cast<float>(y), 1.0F);
    points.emplace_back(0.15F, 0.15F, 3.0F);  // pixel (55, 45), between four of them
    with_points(points, [&](const petal::Run& run, const Cloud& cloud) {
        const CameraImage image = two_halves();
        const PointColours colours(run, cloud, image, Eigen::Isometry3d::Identity());
        EXPECT_GE(colours.cell_px(), 16);
        EXPECT_TRUE(colours.hidden(points.size() - 1));
        Occlusion fine;
        fine.cell_px = 4;
        const PointColours leaky(run, cloud, image, Eigen::Isometry3d::Identity(), fine);
        EXPECT_FALSE(leaky.hidden(points.size() - 1));
    });
}

}  // namespace
}  // namespace petal
