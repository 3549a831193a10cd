// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "metrics/plane_points.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <optional>

#include "petal/calibration/cloud.hpp"
#include "petal/calibration/metrics.hpp"
#include "petal/error.hpp"
#include "petal/testing/stage_harness.hpp"

namespace petal {
namespace {

using ::testing::HasSubstr;
using testing::StageHarness;

constexpr std::uint8_t kBehind = 0, kOfBoard = 1, kBetween = 2;

/// Facing the LiDAR from 4 m.
Eigen::Isometry3d board_at_4m() {
    Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
    T.linear() << 0, 0, 1, -1, 0, 0, 0, -1, 0;
    T.translation() << 4.0, 0.25, 0.25;
    return T;
}

struct OnPlane {
    Eigen::Vector3d point;  ///< board frame, m
    std::uint8_t label;
};

/// The points of each plane; the scene's own cloud holds them in this order.
StageHarness scene_of(const std::vector<std::vector<OnPlane>>& planes) {
    Truth truth;
    truth.T_camera_lidar = Eigen::Isometry3d::Identity();
    truth.boards = {{"four_square_holes_500mm", board_at_4m(), {}, {}}};
    Planes given;
    for (const auto& points : planes) {
        auto map = std::make_shared<mrpt::maps::CPointsMapXYZI>();
        Plane plane;
        for (const OnPlane& one : points) {
            const Eigen::Vector3f p = (board_at_4m() * one.point).cast<float>();
            map->insertPointFast(p.x(), p.y(), p.z());
            plane.inliers.scene_index.push_back(static_cast<std::uint32_t>(truth.labels.size()));
            truth.labels.push_back(one.label);
        }
        plane.inliers.points = map;
        given.planes.push_back(std::move(plane));
    }
    auto stage = StageHarness::of<PlanePointsMetric>("metric.plane_points");
    stage.give<Truth>("truth", std::move(truth), "a");
    stage.give<Planes>("planes", std::move(given), "a");
    return stage;
}

std::optional<double> plane_figure(StageHarness& stage, const std::string& name,
                                   const std::string& scene) {
    for (const Metric& one : stage.out<Metrics>("metrics").values)
        if (one.name == "plane_points." + name && one.scene == scene) return one.value;
    return std::nullopt;
}

TEST(PlanePointsMetric, FiguresByHand) {
    auto stage = scene_of({{{{0.25, 0.25, 0.0}, kOfBoard},    // in the middle
                            {{0.01, 0.25, 0.0}, kOfBoard},    // at the outline
                            {{0.15, 0.09, 0.01}, kOfBoard},   // above the first hole
                            {{0.15, 0.10, 0.02}, kBetween},   // in it
                            {{-0.04, 0.25, 0.0}, kBetween},   // 4 cm beside the board
                            {{-0.06, 0.25, 0.0}, kBetween},   // 6 cm beside: not counted
                            {{0.15, 0.15, 0.04}, kBehind}},   // through a hole
                           {{{0.25, 0.25, 0.5}, kBehind}}});  // another plane
    stage.fire();
    for (const char* scene : {"", "a"}) {
        EXPECT_EQ(plane_figure(stage, "count", scene), 6.0);
        EXPECT_EQ(plane_figure(stage, "board_count", scene), 3.0);
        EXPECT_NEAR(*plane_figure(stage, "edge_share", scene), 2.0 / 3.0, 1e-12);
        EXPECT_NEAR(*plane_figure(stage, "vacant_share", scene), 2.0 / 6.0, 1e-12);
        EXPECT_EQ(plane_figure(stage, "least_side_count", scene), 0.0);
        EXPECT_EQ(plane_figure(stage, "missed_boards", scene), 0.0);
    }
}

TEST(PlanePointsMetric, TheLeastSideIsThePoorestOfSixteen) {
    std::vector<OnPlane> points;
    for (const double x0 : {0.1, 0.3})
        for (const double y0 : {0.1, 0.3})
            for (const double s : {0.03, 0.05, 0.07})
                for (const Eigen::Vector2d& p :
                     {Eigen::Vector2d(x0 + s, y0 - 0.01), Eigen::Vector2d(x0 + s, y0 + 0.11),
                      Eigen::Vector2d(x0 - 0.01, y0 + s), Eigen::Vector2d(x0 + 0.11, y0 + s)})
                    points.push_back({{p.x(), p.y(), 0.0}, kOfBoard});
    auto stage = scene_of({points});
    stage.fire();
    EXPECT_EQ(plane_figure(stage, "least_side_count", ""), 3.0);
    points.pop_back();
    auto poorer = scene_of({points});
    poorer.fire();
    EXPECT_EQ(plane_figure(poorer, "least_side_count", ""), 2.0);
}

TEST(PlanePointsMetric, WithoutPlanesEveryBoardIsMissed) {
    auto stage = scene_of({{{{0.0, 0.0, 5.0}, kBehind}}});
    stage.fire();
    EXPECT_EQ(plane_figure(stage, "missed_boards", "a"), 1.0);
    EXPECT_EQ(plane_figure(stage, "edge_share", "a"), std::nullopt);
}

TEST(PlanePointsMetric, PlanesOfAnotherSceneAreRefused) {
    Truth truth;
    truth.boards = {{"four_square_holes_500mm", board_at_4m(), {}, {}}};
    truth.labels = {kOfBoard};
    auto map = std::make_shared<mrpt::maps::CPointsMapXYZI>();
    map->insertPointFast(4.0F, 0.0F, 0.0F);
    Planes planes;
    planes.planes.emplace_back();
    planes.planes[0].inliers.points = map;
    planes.planes[0].inliers.scene_index = {7};
    auto stage = StageHarness::of<PlanePointsMetric>("metric.plane_points");
    stage.give<Truth>("truth", truth, "a");
    stage.give<Planes>("planes", planes, "a");
    try {
        stage.fire();
        FAIL() << "a point without a label must be refused";
    } catch (const Error& error) {
        EXPECT_THAT(error.what(), HasSubstr("point 7 of the scene's cloud has no label"));
    }
}

TEST(PlanePointsMetric, RealDataHaveNoTruth) {
    auto stage = StageHarness::of<PlanePointsMetric>("metric.plane_points");
    stage.give<Truth>("truth", Truth{}, "a");
    stage.give<Planes>("planes", Planes{}, "a");
    stage.fire();
    EXPECT_TRUE(stage.out<Metrics>("metrics").values.empty());
    ASSERT_EQ(stage.notes().size(), 1U);
    EXPECT_THAT(stage.notes()[0].nearest_miss, HasSubstr("no truth"));
}

}  // namespace
}  // namespace petal
