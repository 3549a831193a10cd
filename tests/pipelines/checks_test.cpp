// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include <gmock/gmock.h>

#include <cmath>

#include "petal_process.hpp"

namespace petal::testing {
namespace {

using nlohmann::json;
using ::testing::AllOf;
using ::testing::HasSubstr;

/// A result of one rig, and new data of the same rig.
class Verify : public PetalProcess {
   protected:
    void SetUp() override {
        PetalProcess::SetUp();
        const Ended ended = petal("run " + pipeline("simulate.json") +
                                  " --set 'scene.scenes=[\"indoor_four_boards\"]' --set "
                                  "scene.duration=3 --seed 8 --out data");
        ASSERT_EQ(ended.exit_code, 0) << ended.err;
        const json truth = json::parse(read_text(folder_ / "data" / "truth.json"));
        json covariance = json::array();
        for (int r = 0; r < 6; ++r) {
            covariance.push_back(json::array());
            for (int c = 0; c < 6; ++c)
                covariance.back().push_back(r == c ? 1e-6 : 0.0);  // 1 mm and 0.06 deg
        }
        result_ = {{"verdict", "usable"},
                   {"reasons", json::array()},
                   {"extrinsics",
                    {{{"camera", "CAMERA"},
                      {"lidar", "LIDAR"},
                      {"T_camera_lidar", truth["T_camera_lidar"]},
                      {"covariance", covariance}}}}};
    }
    void write_result() const { std::ofstream(folder_ / "result.json") << result_.dump(1) << "\n"; }
    /// Turns the result about the camera's y axis.
    void turn(double degrees) {
        json& T = result_["extrinsics"][0]["T_camera_lidar"];
        const double c = std::cos(degrees * M_PI / 180.0), s = std::sin(degrees * M_PI / 180.0);
        for (std::size_t column = 0; column < 4; ++column) {
            const double x = T[0][column], z = T[2][column];
            T[0][column] = c * x + s * z;
            T[2][column] = -s * x + c * z;
        }
    }
    json verified() const { return json::parse(read_text(folder_ / "out" / "result.json")); }

    json result_;
};

TEST(VerifyPipeline, FindsBoardsAsTheCalibrationDoes) {
    const auto stages = [](const std::string& name) {
        return json::parse(read_text(PETAL_SOURCE_DIR "/pipelines/" + name))["stages"];
    };
    const json verify = stages("verify.json"), calibrate = stages("calibrate.json");
    for (const char* stage : {"margins", "sparse", "planes", "lidar_boards", "image_boards"})
        EXPECT_EQ(verify[stage], calibrate[stage]) << stage;
}

TEST_F(Verify, TheTruthAgreesAndHalfADegreeDoesNot) {
    write_result();
    const Ended agrees = petal("verify result.json --data data --out out");
    EXPECT_EQ(agrees.exit_code, 0) << agrees.err << agrees.out;
    const json first = verified();
    EXPECT_EQ(first["verdict"], "usable");
    const json& metrics = first["metrics"];
    EXPECT_GE(metrics["agreement.boards"].get<double>(), 3.0);
    EXPECT_LT(metrics["agreement.reprojection_rms_px"].get<double>(), 3.0);
    EXPECT_GT(metrics["agreement.point_to_edge_count"].get<double>(), 500.0);

    turn(0.5);
    write_result();
    fs::create_directory(folder_ / "run");
    fs::rename(folder_ / "result.json", folder_ / "run" / "result.json");
    const Ended apart = petal("verify run --data data --out out --force");
    EXPECT_EQ(apart.exit_code, 4) << apart.err;
    EXPECT_THAT(apart.out, HasSubstr("the new data do not agree with the result"));
    const json second = verified();
    EXPECT_EQ(second["verdict"], "weak");
    EXPECT_EQ(second["reasons"].size(), 1U);
}

TEST_F(Verify, WrongFilesAndLabelsAreTold) {
    const Ended none = petal("verify result.json --data data --out out");
    EXPECT_EQ(none.exit_code, 2);
    EXPECT_THAT(none.err, HasSubstr("there is no result result.json"));
    write_result();
    EXPECT_EQ(petal("verify result.json").exit_code, 2) << "--data is needed";
    EXPECT_EQ(petal("verify result.json --data nowhere").exit_code, 2);
    const Ended same = petal("verify result.json --data data --out . --force");
    EXPECT_EQ(same.exit_code, 2);
    EXPECT_THAT(same.err, HasSubstr("the folder of the result itself"));

    const Ended scene = petal("verify data/truth.json --data data --out out");
    EXPECT_EQ(scene.exit_code, 1);
    EXPECT_THAT(scene.err, HasSubstr("no result.json of a calibration"));
    fs::create_directory(folder_ / "empty");
    const Ended empty = petal("verify result.json --data empty --out out --force");
    EXPECT_EQ(empty.exit_code, 1);
    EXPECT_THAT(empty.err, HasSubstr("scene.rawlog"));

    result_["extrinsics"][0]["camera"] = "LEFT";
    write_result();
    const Ended label = petal("verify result.json --data data --out out --force");
    EXPECT_EQ(label.exit_code, 1);
    EXPECT_THAT(label.err, AllOf(HasSubstr("camera 'LEFT'"), HasSubstr("'CAMERA'")));
}

/// letter.json with the checks, on data of the simulator.
class Checks : public PetalProcess {
   protected:
    json checked(const std::string& scene) const {
        std::ofstream(folder_ / "sim.json") << json{
            {"stages",
             {{"scene", {{"type", "source.simulator"}, {"params", {{"scenes", {scene}}}}}}}}};
        const Ended ended =
            petal("run " + pipeline("letter.json") + " --with " + pipeline("variants/checks.json") +
                  " --with sim.json --seed 1 --out out " + more_);
        EXPECT_EQ(ended.exit_code, 4) << ended.err;
        const json result = json::parse(read_text(folder_ / "out" / "result.json"));
        for (const json& reason : result["reasons"])
            EXPECT_THAT(ended.out, HasSubstr(reason.get<std::string>()));
        return result;
    }
    std::string more_;
};

TEST_F(Checks, AStillSceneHasFiguresAndABoardThatMovesIsNamed) {
    more_ = "--set scene.duration=5";
    const json still = checked("indoor_floor_3m");
    for (const json& reason : still["reasons"])
        EXPECT_THAT(reason.get<std::string>(), HasSubstr("camera 'CAMERA': "))
            << "the solver's own";
    const json& figures = still["metrics_per_scene"]["indoor_floor_3m"];
    for (const char* name : {"intrinsics.CAMERA.bend_px", "stillness.board_1.motion_mm",
                             "stillness.image_board_1.shift_px", "board_check.board_1.bow_mm"})
        EXPECT_TRUE(figures.contains(name)) << name;
    more_ = "--force";
    EXPECT_THAT(checked("board_moving")["reasons"].dump(),
                AllOf(HasSubstr("board_moving: board 1 moved"),
                      HasSubstr("image board 1 of camera 'CAMERA' moved")));
}

TEST_F(Checks, ABoardThatIsNotTheTargetFilesIsNamed) {
    json target =
        json::parse(read_text(PETAL_SOURCE_DIR "/datasets/targets/four_square_holes_500mm.json"));
    target["name"] = "smaller";
    for (json& p : target["outline"])
        for (json& x : p) x = 0.9 * x.get<double>();
    for (json& hole : target["holes"])
        for (json& p : hole)
            for (json& x : p) x = 0.9 * x.get<double>();
    std::ofstream(folder_ / "smaller.json") << target.dump();
    const std::string smaller = (folder_ / "smaller.json").string();
    json scene = json::parse(read_text(PETAL_SOURCE_DIR "/datasets/scenes/indoor_floor_3m.json"));
    scene["name"] = "wrong_board";
    scene["boards"][0]["target"] = smaller;
    std::ofstream(folder_ / "wrong_board.json") << scene.dump();
    more_ = "--set scene.duration=4 --set 'labels.targets=[\"" + smaller + "\"]'";
    const json result = checked((folder_ / "wrong_board.json").string());
    EXPECT_EQ(result["verdict"], "not_usable");
    EXPECT_THAT(result["reasons"].dump(),
                AllOf(HasSubstr("a plate of 0.45 x 0.45 m"),
                      HasSubstr("'four_square_holes_500mm' says 0.50 x 0.50 m")));
}

}  // namespace
}  // namespace petal::testing
