// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "sources/result.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "petal/calibration/read_result.hpp"
#include "petal/testing/stage_harness.hpp"
#include "plugins/sources/temporary_folder.hpp"

namespace petal {
namespace {

using nlohmann::json;
using ::testing::AllOf;
using ::testing::HasSubstr;
using testing::StageHarness;

json whole_result() {
    json covariance = json::array();
    for (int r = 0; r < 6; ++r) {
        covariance.push_back(json::array());
        for (int c = 0; c < 6; ++c) covariance.back().push_back(r == c ? 1e-6 : 0.0);
    }
    const json T = {{0.0, -1.0, 0.0, 0.04},
                    {0.0, 0.0, -1.0, -0.1},
                    {1.0, 0.0, 0.0, 0.02},
                    {0.0, 0.0, 0.0, 1.0}};
    return {{"verdict", "weak"},
            {"reasons", {"one board only"}},
            {"extrinsics",
             {{{"camera", "CAMERA"},
               {"lidar", "LIDAR"},
               {"T_camera_lidar", T},
               {"covariance", covariance},
               {"sigma_rotation_deg", {0.1, 0.2, 0.3}},
               {"weakest_direction", "tilting"}}}}};
}

class ResultStage : public testing::TemporaryFolder {
   protected:
    std::string refused(const json& result) const {
        const auto file = write("result.json", result.dump(1));
        return refusal([&] { static_cast<void>(read_result(file)); });
    }
    /// What is said of a result whose only camera has this member instead.
    std::string refused(const char* key, const json& value) const {
        json result = whole_result();
        result["extrinsics"][0][key] = value;
        return refused(result);
    }
};

TEST_F(ResultStage, ReadsWhatAResultTells) {
    auto stage = StageHarness::of<ResultSource>("source.result");
    stage.set("file", write("result.json", whole_result().dump(1)).c_str());
    stage.fire();
    const Extrinsics& extrinsics = stage.out<Extrinsics>("extrinsics");
    EXPECT_EQ(extrinsics.level, Level::weak);
    ASSERT_EQ(extrinsics.cameras.size(), 1U);
    const CameraExtrinsics& camera = extrinsics.cameras[0];
    EXPECT_EQ(camera.camera, "CAMERA");
    EXPECT_EQ(camera.lidar, "LIDAR");
    EXPECT_EQ(camera.T_camera_lidar.translation(), Eigen::Vector3d(0.04, -0.1, 0.02));
    EXPECT_NEAR(camera.T_camera_lidar.linear()(2, 0), 1.0, 1e-12);
    EXPECT_EQ(camera.covariance(5, 5), 1e-6);
    EXPECT_NEAR(camera.sigma_rotation.y(), 0.2 / 57.29577951, 1e-9);
    EXPECT_EQ(camera.weakest_direction, "tilting");
    EXPECT_EQ(stage.used_files().size(), 1U);
    EXPECT_EQ(extrinsics.reasons, std::vector<std::string>{"one board only"});
    EXPECT_FALSE(camera.diagnosis);
}

TEST_F(ResultStage, ReadsAFocalLengthThatWasEstimated) {
    const auto focal_of = [&](const json& focal) -> std::optional<Diagnosis::FocalScale> {
        json result = whole_result();
        result["extrinsics"][0]["focal"] = focal;
        const auto camera = read_result(write("result.json", result.dump(1))).cameras.at(0);
        if (!camera.diagnosis) return std::nullopt;
        EXPECT_EQ(camera.diagnosis->covariance_considered, camera.covariance);
        return camera.diagnosis->focal;
    };
    const auto focal = focal_of({{"scale", 1.02}, {"sigma", 0.001}, {"estimated", true}});
    ASSERT_TRUE(focal);
    EXPECT_EQ(focal->scale, 1.02);
    EXPECT_EQ(focal->sigma, 0.001);
    EXPECT_TRUE(focal->estimated);
    EXPECT_FALSE(focal_of({{"scale", 1.02}, {"sigma", 0.001}, {"estimated", false}}));
    EXPECT_THAT(refused("focal", {{"scale", -1.0}, {"sigma", 0.001}, {"estimated", true}}),
                AllOf(HasSubstr("scale"), HasSubstr("must be positive")));
}

TEST_F(ResultStage, EveryKindOfDamageIsToldWithFileAndKey) {
    EXPECT_EQ(refused(whole_result()), "accepted");
    EXPECT_THAT(refusal([&] { static_cast<void>(read_result(folder_ / "none.json")); }),
                HasSubstr("none.json"));
    EXPECT_THAT(
        refusal([&] { static_cast<void>(read_result(write("cut.json", "{\"verdict\": \"we"))); }),
        HasSubstr("cut.json"));
    EXPECT_THAT(refused(json{{"petal_scene", 1}}), HasSubstr("no result.json of a calibration"));
    json empty = whole_result();
    empty["extrinsics"] = json::array();
    EXPECT_THAT(refused(empty), AllOf(HasSubstr("result.json"), HasSubstr("solved nothing")));
    json verdict = whole_result();
    verdict["verdict"] = "fine";
    EXPECT_THAT(refused(verdict), HasSubstr("verdict"));
    json twice = whole_result();
    twice["extrinsics"].push_back(twice["extrinsics"][0]);
    EXPECT_THAT(refused(twice), AllOf(HasSubstr("extrinsics[1]"), HasSubstr("there before")));

    EXPECT_THAT(refused("camera", ""), HasSubstr("extrinsics[0].camera"));
    EXPECT_THAT(refused("T_camera_lidar", 3), HasSubstr("4 x 4 matrix"));
    json T = whole_result()["extrinsics"][0]["T_camera_lidar"];
    T.erase(3);
    EXPECT_THAT(refused("T_camera_lidar", T), HasSubstr("not 3 rows"));
    T = whole_result()["extrinsics"][0]["T_camera_lidar"];
    T[0][1] = -1.01;
    EXPECT_THAT(refused("T_camera_lidar", T), HasSubstr("no rotation"));
    T[0][1] = 1.0;  // a mirror
    EXPECT_THAT(refused("T_camera_lidar", T), HasSubstr("no rotation"));
    T[0][1] = nullptr;  // what a NaN becomes in JSON
    EXPECT_THAT(refused("T_camera_lidar", T), HasSubstr("T_camera_lidar[0][1]"));
    T = whole_result()["extrinsics"][0]["T_camera_lidar"];
    T[3][0] = 1.0;
    EXPECT_THAT(refused("T_camera_lidar", T), HasSubstr("last row"));
    json C = whole_result()["extrinsics"][0]["covariance"];
    C[0][1] = 1e-6;
    EXPECT_THAT(refused("covariance", C), HasSubstr("not symmetric"));
    C[0][1] = 0.0;
    C[2][2] = -1e-6;
    EXPECT_THAT(refused("covariance", C), HasSubstr("negative variance"));
}

}  // namespace
}  // namespace petal
