// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include <gmock/gmock.h>

#include "petal_process.hpp"

namespace petal::testing {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;

class ImportFiles : public PetalProcess {
   protected:
    void SetUp() override {
        PetalProcess::SetUp();
        ASSERT_EQ(run_program("petal_synthetic_scene", "data").exit_code, 0);
        ASSERT_EQ(
            petal("run " + pipeline("import_files.json") + " --data data --out rawlog").exit_code,
            0);
    }
};

TEST_F(ImportFiles, MakesARawlogThatMrptsToolOpens) {
    const fs::path rawlog = folder_ / "rawlog" / "scene.rawlog";
    ASSERT_TRUE(fs::exists(rawlog));
    if (std::system("command -v rawlog-edit >/dev/null") != 0)
        GTEST_SKIP() << "rawlog-edit (Debian's mrpt-apps) is not installed";
    const fs::path told = folder_ / "told";
    const std::string command =
        "rawlog-edit --info -i '" + rawlog.string() + "' >'" + told.string() + "' 2>&1";
    EXPECT_EQ(std::system(command.c_str()), 0);
    EXPECT_THAT(read_text(told), HasSubstr("Overall number of objects         : 2"));
    EXPECT_THAT(read_text(told), HasSubstr("CAMERA"));
}

// The rawlog holds what the files held, so the calibration from it is the same to the last digit.
TEST_F(ImportFiles, ACalibrationFromTheRawlogIsThatFromTheFiles) {
    petal("run " + pipeline("letter_indoor.json") + " --data data --out files");
    std::ofstream(folder_ / "from_rawlog.json")
        << R"({"stages": {"scene": {"type": "source.rawlog"}}})";
    const Ended ended = petal("run " + pipeline("letter_indoor.json") +
                              " --with from_rawlog.json --data rawlog --out again");
    ASSERT_THAT(ended.exit_code, ::testing::AnyOf(0, 4)) << ended.err;
    const json files = json::parse(read_text(folder_ / "files" / "result.json"));
    const json again = json::parse(read_text(folder_ / "again" / "result.json"));
    EXPECT_EQ(files["extrinsics"], again["extrinsics"]);
    EXPECT_EQ(files["scenes"][0]["boards"], again["scenes"][0]["boards"]);
}

TEST_F(ImportFiles, ALabelThatIsNotThereListsWhatIs) {
    std::ofstream(folder_ / "from_rawlog.json")
        << R"({"stages": {"scene": {"type": "source.rawlog", "params": {"lidar": "LIVOX"}}}})";
    const Ended ended = petal("run " + pipeline("letter_indoor.json") +
                              " --with from_rawlog.json --data rawlog --out again");
    EXPECT_EQ(ended.exit_code, 1);
    EXPECT_THAT(ended.err, HasSubstr("LIVOX"));
    EXPECT_THAT(ended.err, HasSubstr("LIDAR"));
    EXPECT_THAT(ended.err, HasSubstr("CObservationPointCloud"));
}

TEST_F(ImportFiles, ATruncatedRawlogIsAnError) {
    const fs::path rawlog = folder_ / "rawlog" / "scene.rawlog";
    fs::resize_file(rawlog, fs::file_size(rawlog) / 2);
    std::ofstream(folder_ / "from_rawlog.json")
        << R"({"stages": {"scene": {"type": "source.rawlog"}}})";
    const Ended ended = petal("run " + pipeline("letter_indoor.json") +
                              " --with from_rawlog.json --data rawlog --out again");
    EXPECT_EQ(ended.exit_code, 1);
    EXPECT_THAT(ended.err, HasSubstr("scene.rawlog"));
    EXPECT_FALSE(fs::exists(folder_ / "again" / "result.json"));
}

}  // namespace
}  // namespace petal::testing
