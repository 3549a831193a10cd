// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include <gmock/gmock.h>

#include "petal_process.hpp"

namespace petal::testing {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

/// An earlier run, with no more than what its result tells.
class ExportPipeline : public PetalProcess {
   protected:
    void write_result(const std::string& verdict) const {
        nlohmann::json identity = nlohmann::json::array();
        for (int r = 0; r < 6; ++r) {
            nlohmann::json row(std::vector<double>(6, 0.0));
            row[static_cast<std::size_t>(r)] = 1e-8;
            identity.push_back(row);
        }
        const nlohmann::json result{
            {"verdict", verdict},
            {"reasons", {"because"}},
            {"extrinsics",
             {{{"camera", "CAMERA"},
               {"lidar", "LIDAR"},
               {"T_camera_lidar",
                {{0, -1, 0, 0.04}, {0, 0, -1, -0.11}, {1, 0, 0, -0.03}, {0, 0, 0, 1}}},
               {"covariance", identity}}}}};
        fs::create_directories(folder_ / "earlier");
        std::ofstream(folder_ / "earlier" / "result.json") << result;
    }
};

TEST_F(ExportPipeline, AnEarlierResultIsWrittenInEveryFormat) {
    write_result("usable");
    const Ended ended = petal("run " + pipeline("export.json") + " --data earlier --out out");
    EXPECT_EQ(ended.exit_code, 0) << ended.err;
    for (const char* name :
         {"static_transforms.launch", "static_transforms.launch.xml", "sensor_kit_calibration.yaml",
          "camchain.yaml", "fast_livo2.yaml", "opencv.yaml", "mrpt.ini"}) {
        const std::string text = read_text(folder_ / "out" / "export" / name);
        EXPECT_THAT(text, HasSubstr("the LiDAR sits 4.0 cm right of, 11.0 cm above")) << name;
        EXPECT_THAT(text, Not(HasSubstr("VERDICT"))) << name;
    }
}

TEST_F(ExportPipeline, AWeakOneSaysSoInTheFilesAndByTheExitCode) {
    write_result("weak");
    const Ended ended = petal("run " + pipeline("export.json") +
                              " --data earlier --out out --set 'export.formats=[\"mrpt\"]'");
    EXPECT_EQ(ended.exit_code, 4) << ended.err;
    EXPECT_THAT(read_text(folder_ / "out" / "export" / "mrpt.ini"), HasSubstr("; - because"));
}

TEST_F(ExportPipeline, IntrinsicsComeFromTheRawlogByAVariant) {
    write_result("usable");
    // A scene of the simulator in place of the rawlog: the patch after the variant wins.
    std::ofstream(folder_ / "simulated.json")
        << R"({"petal": 1, "stages": {"scene": {"type": "source.simulator",
               "params": {"scenes": ["indoor_floor_3m"], "duration": 0.1}}}})";
    const Ended ended = petal("run " + pipeline("export.json") + " --with " +
                              pipeline("variants/export_intrinsics.json") +
                              " --with simulated.json --data earlier --out out");
    EXPECT_EQ(ended.exit_code, 0) << ended.err;
    EXPECT_THAT(read_text(folder_ / "out" / "export" / "fast_livo2.yaml"),
                HasSubstr("cam_width: 1280"));
}

TEST_F(ExportPipeline, ACopyOfTheRawlogHasThePoses) {
    write_result("usable");
    ASSERT_EQ(
        petal("run " + pipeline("simulate.json") + " --set scene.duration=0.1 --out sim").exit_code,
        0);
    const Ended ended = petal("run " + pipeline("calibrated_rawlog.json") +
                              " --data sim --set 'known.file=\"earlier/result.json\"' --out out");
    EXPECT_EQ(ended.exit_code, 0) << ended.err;
    const Ended inspected = petal("inspect out/scene_calibrated.rawlog");
    EXPECT_EQ(inspected.exit_code, 0) << inspected.err;
    EXPECT_THAT(inspected.out, HasSubstr("CAMERA"));
}

}  // namespace
}  // namespace petal::testing
