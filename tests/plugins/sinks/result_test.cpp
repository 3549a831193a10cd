// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "sinks/result.hpp"

#include <gmock/gmock.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "petal/testing/stage_harness.hpp"
#include "sinks/detail/result_json.hpp"

namespace petal {
namespace {

using nlohmann::json;
using testing::StageHarness;

std::vector<Eigen::Vector3d> corners_lidar(double first) {
    std::vector<Eigen::Vector3d> corners;
    for (int i = 0; i < 16; ++i) corners.emplace_back(first + i, 0.0, 0.0);
    return corners;
}

std::vector<Eigen::Vector2d> corners_image(double first) {
    std::vector<Eigen::Vector2d> corners;
    for (int i = 0; i < 16; ++i) corners.emplace_back(first + i, 0.0);
    return corners;
}

/// Two boards of the LiDAR, two of the camera; LiDAR board 1 is camera board 0, turned by 180
/// degrees.
struct Example {
    LidarBoards lidar{"LIDAR", {}};
    ImageBoards image;
    Correspondences pairs;
    Extrinsics extrinsics;

    Example() {
        for (const double first : {0.0, 100.0}) {
            LidarBoard board;
            board.target = "t";
            board.corners = corners_lidar(first);
            lidar.boards.push_back(board);
            ImageBoard seen;
            seen.target = "t";
            seen.camera = "CAMERA";
            seen.corners = corners_image(first);
            image.boards.push_back(seen);
        }
        image.cameras.push_back({"CAMERA", {}});
        CameraPairs camera;
        camera.scene_name = "hall";
        camera.camera = "CAMERA";
        camera.lidar = "LIDAR";
        camera.boards.emplace_back();
        camera.boards.back().lidar = 1;
        camera.boards.back().image = 0;
        for (int corner = 15; corner >= 0; --corner) {
            PointPair pair;
            pair.board = 0;
            pair.corner = corner;
            pair.image = image.boards[0].corners[static_cast<std::size_t>(corner)];
            pair.lidar = lidar.boards[1].corners[static_cast<std::size_t>(15 - corner)];
            camera.pairs.push_back(pair);
        }
        pairs.cameras.push_back(camera);

        CameraExtrinsics solved;
        solved.camera = "CAMERA";
        solved.lidar = "LIDAR";
        solved.T_camera_lidar.translation() << 0.04, -0.11, -0.03;
        solved.covariance.setIdentity();
        solved.sigma_rotation << M_PI / 180.0, 0.0, 0.0;
        solved.order.by = DecidedBy::prior;
        solved.order.runner_up_rms_ratio = 1.2;
        solved.residuals.push_back({0, 0, 0, {0, 0}, {3.0, 4.0}});
        solved.residuals.push_back({0, 0, 1, {0, 0}, {0.0, 0.0}});
        extrinsics.cameras.push_back(solved);
        extrinsics.level = Level::weak;
        extrinsics.reasons = {"two boards only"};
    }

    StageHarness harness() const {
        StageHarness sink = StageHarness::of<ResultSink>();
        sink.give<Extrinsics>("extrinsics", extrinsics)
            .give<Correspondences>("correspondences", pairs)
            .give<LidarBoards>("lidar_boards", lidar, "hall")
            .give<ImageBoards>("image_boards", image, "hall");
        return sink;
    }
};

json result_of(StageHarness& sink) {
    sink.fire();
    std::ifstream in(sink.folder() / "result.json");
    return json::parse(in);
}

TEST(ResultSinkTest, TellsTheCalibration) {
    StageHarness sink = Example().harness();
    const json result = result_of(sink);
    EXPECT_EQ(result["verdict"], "weak");
    EXPECT_EQ(result["reasons"][0], "two boards only");
    const json& camera = result["extrinsics"][0];
    EXPECT_EQ(camera["T_camera_lidar"][0][3], 0.04);
    EXPECT_EQ(camera["T_lidar_camera"][1][3], 0.11);
    EXPECT_NEAR(camera["sigma_rotation_deg"][0].get<double>(), 1.0, 1e-12);
    EXPECT_EQ(camera["sentence"],
              "the LiDAR sits 4.0 cm right of, 11.0 cm above and 3.0 cm behind the camera");
    EXPECT_EQ(result["orientation"]["decided_by"], "prior");
    EXPECT_EQ(result["orientation"]["runner_up_rms_ratio"], 1.2);
    // Lengths 5 and 0: mean 2.5, RMS sqrt(25 / 2).
    EXPECT_EQ(result["residuals"]["count"], 2);
    EXPECT_NEAR(result["residuals"]["rms_px"].get<double>(), std::sqrt(12.5), 1e-12);
    EXPECT_EQ(result["residuals"]["mean_px"], 2.5);
    EXPECT_EQ(result["residuals"]["max_px"], 5.0);
    EXPECT_EQ(result["residuals"]["per_scene"][0]["scene"], "hall");
}

TEST(ResultSinkTest, BoardsStandInTheCamerasOrderAndLoneOnesHaveNull) {
    StageHarness sink = Example().harness();
    const json result = result_of(sink);
    ASSERT_EQ(result["scenes"].size(), 1U);
    EXPECT_EQ(result["scenes"][0]["name"], "hall");
    const json& boards = result["scenes"][0]["boards"];
    ASSERT_EQ(boards.size(), 3U);
    EXPECT_EQ(boards[0]["camera"], "CAMERA");
    for (std::size_t corner = 0; corner < 16; ++corner) {
        EXPECT_EQ(boards[0]["corners_image"][corner][0], static_cast<double>(corner));
        EXPECT_EQ(boards[0]["corners_lidar"][corner][0], 115.0 - static_cast<double>(corner));
    }
    EXPECT_TRUE(boards[1]["camera"].is_null());
    EXPECT_TRUE(boards[1]["corners_image"].is_null());
    EXPECT_EQ(boards[1]["corners_lidar"].size(), 16U);
    EXPECT_EQ(boards[2]["camera"], "CAMERA");
    EXPECT_TRUE(boards[2]["corners_lidar"].is_null());
    EXPECT_EQ(boards[2]["corners_image"][0][0], 100.0);
}

TEST(ResultSinkTest, BoardsOfGivenPairsAreToldWithoutADetectorsBoard) {
    Example example;
    example.pairs.cameras[0].boards.clear();  // as source.pairs writes them
    StageHarness sink = StageHarness::of<ResultSink>();
    sink.give<Extrinsics>("extrinsics", example.extrinsics)
        .give<Correspondences>("correspondences", example.pairs);
    const json result = result_of(sink);
    ASSERT_EQ(result["scenes"][0]["boards"].size(), 1U);
    EXPECT_EQ(result["scenes"][0]["boards"][0]["corners_lidar"].size(), 16U);
}

TEST(ResultSinkTest, TakesMetricsOfSeveralStages) {
    StageHarness sink = Example().harness();
    sink.give<Metrics>("metrics", Metrics{{{"reprojection.rms_px", 0.5, "px", ""}}});
    sink.give<Metrics>("metrics", Metrics{{{"truth.rotation_deg", 0.1, "deg", ""},
                                           {"truth.rotation_deg", 0.2, "deg", "hall"}}});
    const json result = result_of(sink);
    EXPECT_EQ(result["metrics"]["reprojection.rms_px"], 0.5);
    EXPECT_EQ(result["metrics"]["truth.rotation_deg"], 0.1);
    EXPECT_EQ(result["metrics_per_scene"]["hall"]["truth.rotation_deg"], 0.2);
}

TEST(ResultSinkTest, FindingsLowerTheVerdictAndAreToldOnce) {
    Example example;
    example.lidar.findings = {"the target may be another"};
    StageHarness sink = example.harness();
    Metrics checks;
    checks.findings = {{Level::not_usable, "cx lies outside"}, {Level::weak, "board 1 moved"}};
    sink.give<Metrics>("metrics", checks, "hall").give<Metrics>("metrics", checks, "court");
    const json result = result_of(sink);
    EXPECT_EQ(result["verdict"], "not_usable");
    EXPECT_EQ(result["reasons"], json({"two boards only", "cx lies outside", "board 1 moved",
                                       "the target may be another"}));
    // The solver tells its own reasons: the sink adds the level and the reasons of the checks.
    EXPECT_EQ(sink.verdict(), Level::not_usable);
    EXPECT_EQ(sink.reasons().size(), 3U);
}

TEST(ResultSinkTest, WithoutFindingsTheSinkJudgesNothing) {
    StageHarness sink = Example().harness();
    EXPECT_EQ(result_of(sink)["verdict"], "weak");
    EXPECT_FALSE(sink.verdict().has_value());
}

TEST(ResultSinkTest, DetectorsFindingsMakeWeakAndNameTheirScene) {
    Example example;
    example.extrinsics.level = Level::usable;
    example.extrinsics.reasons.clear();
    example.image.findings = {"edges are blurred"};
    StageHarness sink = StageHarness::of<ResultSink>();
    sink.give<Extrinsics>("extrinsics", example.extrinsics)
        .give<ImageBoards>("image_boards", example.image, "hall")
        .give<ImageBoards>("image_boards", ImageBoards{}, "court");
    const json result = result_of(sink);
    EXPECT_EQ(result["verdict"], "weak");
    EXPECT_EQ(result["reasons"], json({"hall: edges are blurred"}));
}

TEST(ResultSinkTest, NothingSolvedIsStillAResult) {
    StageHarness sink = StageHarness::of<ResultSink>();
    sink.give<Extrinsics>("extrinsics", Extrinsics{});
    const json result = result_of(sink);
    EXPECT_EQ(result["verdict"], "not_usable");
    EXPECT_TRUE(result["extrinsics"].empty());
    EXPECT_EQ(result["residuals"]["count"], 0);
    EXPECT_EQ(result["orientation"]["decided_by"], "undecided");
}

TEST(ResultSinkTest, AFileOutsideTheRunFolderIsRefused) {
    StageHarness sink = StageHarness::of<ResultSink>();
    sink.set("file", "../result.json").give<Extrinsics>("extrinsics", Extrinsics{});
    EXPECT_THROW(sink.fire(), Error);
}

TEST(PlacementSentence, LeavesOutWhatIsNothingAndKeepsSigns) {
    Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
    EXPECT_EQ(placement_sentence(T), "the LiDAR sits at the camera's centre");
    T.translation() << -0.0462, 0.0, 0.0;
    EXPECT_EQ(placement_sentence(T), "the LiDAR sits 4.6 cm left of the camera");
    T.translation() << 0.0, 0.1502, 0.0673;
    EXPECT_EQ(placement_sentence(T),
              "the LiDAR sits 15.0 cm below and 6.7 cm in front of the camera");
}

}  // namespace
}  // namespace petal
