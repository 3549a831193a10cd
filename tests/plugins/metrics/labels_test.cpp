// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "metrics/labels.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <limits>
#include <optional>

#include "petal/calibration/cloud.hpp"
#include "petal/calibration/metrics.hpp"
#include "petal/calibration/target.hpp"
#include "petal/calibration/truth.hpp"
#include "petal/error.hpp"
#include "petal/testing/stage_harness.hpp"

namespace petal {
namespace {

using ::testing::HasSubstr;
using testing::StageHarness;

constexpr std::uint8_t kBackground = 0, kBoard = 1, kVacant = 2, kOther = 3;
const char* const kSquare = "four_square_holes_500mm";

struct Labelled {
    Eigen::Vector3d point;  ///< board frame: x right, y down, z into the board, m
    std::uint8_t label;
};

/// Facing the LiDAR from 4 m, rolled by 20 deg so that no axis of the LiDAR lies along a side.
Eigen::Isometry3d T_lidar_board(double left = 0.0) {
    Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
    T.linear() << 0, 0, 1, -1, 0, 0, 0, -1, 0;
    T.translation() << 4.0, left, 0.3;
    T.rotate(Eigen::AngleAxisd(0.35, Eigen::Vector3d::UnitZ()));
    return T;
}

Truth truth_of(const std::vector<Labelled>& points,
               std::vector<Truth::Board> boards = {{kSquare, T_lidar_board(), {}, {}}}) {
    Truth truth;
    truth.T_camera_lidar = Eigen::Isometry3d::Identity();
    truth.boards = std::move(boards);
    for (const Labelled& one : points) truth.labels.push_back(one.label);
    return truth;
}

Cloud cloud_of(const std::vector<Labelled>& points, const Eigen::Isometry3d& T = T_lidar_board()) {
    auto map = std::make_shared<mrpt::maps::CPointsMapXYZI>();
    for (const Labelled& one : points) {
        const Eigen::Vector3f p = (T * one.point).cast<float>();
        map->insertPointFast(p.x(), p.y(), p.z());
    }
    Cloud cloud;
    cloud.points = map;
    return cloud;
}

Cloud part_of(const std::vector<Labelled>& points, std::vector<std::uint32_t> indices) {
    std::vector<Labelled> taken;
    for (const std::uint32_t i : indices) taken.push_back(points[i]);
    Cloud cloud = cloud_of(taken);
    cloud.scene_index = std::move(indices);
    return cloud;
}

std::optional<double> share(const Metrics& metrics, const std::string& name,
                            const std::string& scene = "") {
    for (const Metric& one : metrics.values)
        if (one.name == "labels." + name && one.scene == scene) return one.value;
    return std::nullopt;
}

StageHarness one_scene(Truth truth, Cloud before, Cloud after) {
    auto stage = StageHarness::of<LabelsMetric>("metric.labels");
    stage.give<Truth>("truth", std::move(truth), "a");
    stage.give<Cloud>("before", std::move(before), "a");
    stage.give<Cloud>("after", std::move(after), "a");
    return stage;
}

std::string refusal(Truth truth, Cloud before, Cloud after) {
    auto stage = one_scene(std::move(truth), std::move(before), std::move(after));
    try {
        stage.fire();
    } catch (const Error& error) {
        return error.what();
    }
    return "";
}

/// Ten points: three at an edge, two on the board away from it, two vacant, two background, one
/// other.
const std::vector<Labelled> kTen = {
    {{0.005, 0.25, 0.0}, kBoard},      // at the left side of the outline
    {{0.089, 0.15, 0.002}, kBoard},    // 11 mm from a hole
    {{0.194, 0.35, 0.004}, kBoard},    // on the wall of a hole, seen through it
    {{0.25, 0.25, 0.001}, kBoard},     // in the middle
    {{0.0865, 0.15, 0.0}, kBoard},     // 13.5 mm from a hole
    {{0.1, 0.15, 0.5}, kVacant},       // behind an edge
    {{0.5, 0.2, 0.3}, kVacant},        //
    {{0.15, 0.15, 3.0}, kBackground},  // through a hole
    {{0.1, 0.1, 6.0}, kBackground},    //
    {{0.0, 0.0, -1.0}, kOther}};

TEST(LabelsMetric, SharesByHand) {
    // A filter that takes a vacant point, an edge point and a background point.
    auto stage = one_scene(truth_of(kTen), cloud_of(kTen), part_of(kTen, {1, 2, 3, 4, 6, 7, 9}));
    stage.fire();
    const auto& told = stage.out<Metrics>("metrics");
    for (const char* scene : {"", "a"}) {
        EXPECT_DOUBLE_EQ(*share(told, "before.count", scene), 10.0);
        EXPECT_DOUBLE_EQ(*share(told, "before.vacant_share", scene), 0.2);
        EXPECT_DOUBLE_EQ(*share(told, "before.board_share", scene), 0.5);
        EXPECT_DOUBLE_EQ(*share(told, "before.edge_share", scene), 0.3);
        EXPECT_DOUBLE_EQ(*share(told, "before.background_share", scene), 0.2);
        EXPECT_DOUBLE_EQ(*share(told, "before.other_share", scene), 0.1);
        EXPECT_DOUBLE_EQ(*share(told, "after.count", scene), 7.0);
        EXPECT_DOUBLE_EQ(*share(told, "after.vacant_share", scene), 1.0 / 7.0);
        EXPECT_DOUBLE_EQ(*share(told, "after.board_share", scene), 4.0 / 7.0);
        EXPECT_DOUBLE_EQ(*share(told, "after.edge_share", scene), 2.0 / 7.0);
        EXPECT_DOUBLE_EQ(*share(told, "after.background_share", scene), 1.0 / 7.0);
        EXPECT_DOUBLE_EQ(*share(told, "after.other_share", scene), 1.0 / 7.0);
        EXPECT_DOUBLE_EQ(*share(told, "vacant_removed_share", scene), 0.5);
        EXPECT_DOUBLE_EQ(*share(told, "edge_kept_share", scene), 2.0 / 3.0);
        EXPECT_DOUBLE_EQ(*share(told, "board_kept_share", scene), 0.8);
    }
    EXPECT_TRUE(stage.notes().empty());
    EXPECT_EQ(stage.used_files().size(), 1U);
}

TEST(LabelsMetric, TheDistanceOfAnEdgeIsAParameter) {
    const auto edges = [](double distance) {
        auto stage = one_scene(truth_of(kTen), cloud_of(kTen), cloud_of(kTen));
        stage.set("edge_distance", distance).fire();
        return *share(stage.out<Metrics>("metrics"), "before.edge_share");
    };
    EXPECT_DOUBLE_EQ(edges(0.001), 0.0);
    EXPECT_DOUBLE_EQ(edges(0.007), 0.2);
    EXPECT_DOUBLE_EQ(edges(0.014), 0.4);
    EXPECT_DOUBLE_EQ(edges(0.5), 0.5);
}

TEST(LabelsMetric, AFilterThatTakesNothing) {
    auto stage = one_scene(truth_of(kTen), cloud_of(kTen), cloud_of(kTen));
    stage.fire();
    const auto& told = stage.out<Metrics>("metrics");
    EXPECT_DOUBLE_EQ(*share(told, "vacant_removed_share"), 0.0);
    EXPECT_DOUBLE_EQ(*share(told, "edge_kept_share"), 1.0);
    EXPECT_DOUBLE_EQ(*share(told, "board_kept_share"), 1.0);
}

TEST(LabelsMetric, AFilterThatTakesAll) {
    auto stage = one_scene(truth_of(kTen), cloud_of(kTen), Cloud{});
    stage.fire();
    const auto& told = stage.out<Metrics>("metrics");
    EXPECT_DOUBLE_EQ(*share(told, "after.count"), 0.0);
    EXPECT_FALSE(share(told, "after.vacant_share"));
    EXPECT_DOUBLE_EQ(*share(told, "vacant_removed_share"), 1.0);
    EXPECT_DOUBLE_EQ(*share(told, "edge_kept_share"), 0.0);
}

TEST(LabelsMetric, TheSecondOfTwoFilters) {
    // Before it are only the points that the first one left, in another order.
    auto stage = one_scene(truth_of(kTen), part_of(kTen, {6, 5, 0, 3}), part_of(kTen, {0, 6}));
    stage.fire();
    const auto& told = stage.out<Metrics>("metrics");
    EXPECT_DOUBLE_EQ(*share(told, "before.vacant_share"), 0.5);
    EXPECT_DOUBLE_EQ(*share(told, "before.edge_share"), 0.25);
    EXPECT_DOUBLE_EQ(*share(told, "vacant_removed_share"), 0.5);
    EXPECT_DOUBLE_EQ(*share(told, "edge_kept_share"), 1.0);
    EXPECT_DOUBLE_EQ(*share(told, "board_kept_share"), 0.5);
}

TEST(LabelsMetric, AFilterThatMovesPointsMakesNoOtherEdges) {
    std::vector<Labelled> moved = kTen;
    for (Labelled& one : moved) one.point += Eigen::Vector3d(0.02, 0.02, 0.0);
    auto stage = one_scene(truth_of(kTen), cloud_of(kTen), cloud_of(moved));
    stage.fire();
    EXPECT_DOUBLE_EQ(*share(stage.out<Metrics>("metrics"), "after.edge_share"), 0.3);
}

TEST(LabelsMetric, TotalsAreOfAllPointsSoFar) {
    auto stage = StageHarness::of<LabelsMetric>("metric.labels");
    const std::vector<Labelled> two = {kTen[5], kTen[3]};
    stage.give<Truth>("truth", truth_of(kTen), "a").give<Truth>("truth", truth_of(two), "b");
    stage.give<Cloud>("before", cloud_of(kTen), "a").give<Cloud>("before", cloud_of(two), "b");
    stage.give<Cloud>("after", cloud_of(kTen), "a").give<Cloud>("after", part_of(two, {1}), "b");
    stage.fire();
    const auto packets = stage.all<Metrics>("metrics");
    ASSERT_EQ(packets.size(), 2U);
    EXPECT_DOUBLE_EQ(*share(*packets[0].value, "before.vacant_share"), 0.2);
    EXPECT_DOUBLE_EQ(*share(*packets[1].value, "before.vacant_share", "b"), 0.5);
    EXPECT_FALSE(share(*packets[1].value, "before.vacant_share", "a"));
    EXPECT_DOUBLE_EQ(*share(*packets[1].value, "before.vacant_share"), 0.25);  // 3 of 12
    EXPECT_DOUBLE_EQ(*share(*packets[1].value, "vacant_removed_share"), 1.0 / 3.0);
    EXPECT_DOUBLE_EQ(*share(*packets[1].value, "edge_kept_share"), 1.0);
    EXPECT_EQ(stage.used_files().size(), 1U);  // read once
}

TEST(LabelsMetric, RealScenesHaveNoFigures) {
    auto stage = one_scene(Truth{}, cloud_of(kTen), part_of(kTen, {1}));
    stage.fire();
    EXPECT_TRUE(stage.out<Metrics>("metrics").values.empty());
    ASSERT_EQ(stage.notes().size(), 1U);
    EXPECT_THAT(stage.notes()[0].nearest_miss, HasSubstr("no truth: 1 of 1 scenes"));
    EXPECT_THAT(stage.notes()[0].nearest_miss, HasSubstr("'a'"));
}

TEST(LabelsMetric, WithoutBoardsThereAreNoEdges) {
    auto stage = one_scene(truth_of(kTen, {}), cloud_of(kTen), cloud_of(kTen));
    stage.fire();
    const auto& told = stage.out<Metrics>("metrics");
    EXPECT_DOUBLE_EQ(*share(told, "before.board_share"), 0.5);
    EXPECT_FALSE(share(told, "before.edge_share"));
    EXPECT_FALSE(share(told, "edge_kept_share"));
    ASSERT_EQ(stage.notes().size(), 1U);
    EXPECT_EQ(stage.notes()[0].looked_for, "edge points");
}

TEST(LabelsMetric, APointBelongsToTheNearestBoard) {
    // The second board stands 0.4 m behind the first, shifted by 10 cm: in its own plane each point
    // of kTen lies elsewhere.
    Eigen::Isometry3d behind = T_lidar_board();
    behind.translate(Eigen::Vector3d(0.1, 0.1, 0.4));
    for (const bool turned : {false, true}) {
        std::vector<Truth::Board> boards = {{kSquare, T_lidar_board(), {}, {}},
                                            {kSquare, behind, {}, {}}};
        if (turned) std::swap(boards[0], boards[1]);
        auto stage = one_scene(truth_of(kTen, boards), cloud_of(kTen), cloud_of(kTen));
        stage.fire();
        EXPECT_DOUBLE_EQ(*share(stage.out<Metrics>("metrics"), "before.edge_share"), 0.3);
    }
}

TEST(LabelsMetric, RoundHolesHaveEdges) {
    const auto target = load_target("four_round_holes_aruco");
    ASSERT_FALSE(target.round_holes.empty());
    const auto& hole = target.round_holes.front();
    const auto at = [&](double beyond) {
        const Eigen::Vector2d p = hole.centre + (hole.radius + beyond) * Eigen::Vector2d(0.6, 0.8);
        return Labelled{{p.x(), p.y(), 0.0}, kBoard};
    };
    const std::vector<Labelled> points = {at(0.011), at(-0.011), at(0.013), at(-0.013)};
    auto stage = one_scene(truth_of(points, {{"four_round_holes_aruco", T_lidar_board(), {}, {}}}),
                           cloud_of(points), cloud_of(points));
    stage.fire();
    EXPECT_DOUBLE_EQ(*share(stage.out<Metrics>("metrics"), "before.edge_share"), 0.5);
}

TEST(LabelsMetric, PointsWithNaNAreNoEdge) {
    std::vector<Labelled> points = {kTen[0], kTen[0]};
    points[1].point.x() = std::numeric_limits<double>::quiet_NaN();
    auto stage = one_scene(truth_of(points), cloud_of(points), cloud_of(points));
    stage.fire();
    EXPECT_DOUBLE_EQ(*share(stage.out<Metrics>("metrics"), "before.edge_share"), 0.5);
    EXPECT_DOUBLE_EQ(*share(stage.out<Metrics>("metrics"), "before.board_share"), 1.0);
}

TEST(LabelsMetric, CloudsThatDoNotFitTheLabelsAreRefused) {
    Cloud bare = part_of(kTen, {1, 2, 3});
    bare.scene_index.clear();
    EXPECT_THAT(refusal(truth_of(kTen), cloud_of(kTen), bare),
                ::testing::AllOf(HasSubstr("scene 'a'"), HasSubstr("port 'after' has 3 points"),
                                 HasSubstr("10 labels"), HasSubstr("scene_index")));
    EXPECT_THAT(refusal(truth_of(kTen), bare, cloud_of(kTen)), HasSubstr("port 'before'"));
    Cloud beyond = part_of(kTen, {1, 2, 3});
    beyond.scene_index[1] = 10;
    EXPECT_THAT(refusal(truth_of(kTen), cloud_of(kTen), beyond), HasSubstr("point 10"));
    Cloud uneven = part_of(kTen, {1, 2, 3});
    uneven.scene_index.pop_back();
    EXPECT_THAT(refusal(truth_of(kTen), cloud_of(kTen), uneven), HasSubstr("2 entries"));
    Truth strange = truth_of(kTen);
    strange.labels[4] = 4;
    EXPECT_THAT(refusal(strange, cloud_of(kTen), cloud_of(kTen)), HasSubstr("point 4 has label 4"));
}

TEST(LabelsMetric, TargetsOfOnesOwn) {
    const auto truth = truth_of(kTen, {{"mine", T_lidar_board(), {}, {}}});
    EXPECT_THAT(refusal(truth, cloud_of(kTen), cloud_of(kTen)),
                ::testing::AllOf(HasSubstr("'mine'"), HasSubstr("'targets'")));

    auto stage = one_scene(truth, cloud_of(kTen), cloud_of(kTen));
    const auto file = stage.folder() / "board.json";
    std::filesystem::create_directories(stage.folder());
    std::ofstream(file) << R"({"petal_target": 1, "name": "mine", "thickness": 0.0,
        "outline": [[0, 0], [0.5, 0], [0.5, 0.5], [0, 0.5]],
        "holes": [[[0.2, 0.2], [0.3, 0.2], [0.3, 0.3], [0.2, 0.3]]]})";
    stage.set("targets", Value(std::vector<std::string>{file.string()})).fire();
    EXPECT_DOUBLE_EQ(*share(stage.out<Metrics>("metrics"), "before.edge_share"), 0.1);
}

}  // namespace
}  // namespace petal
