// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include <gmock/gmock.h>

#include "petal_child.hpp"
#include "petal_process.hpp"
#include "rawlog/rawlog_bytes.hpp"
#include "real_data.hpp"

namespace petal::testing {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;
using ::testing::Not;

class Inspect : public PetalProcess {
   protected:
    void write(const std::string& name, const std::string& bytes) const {
        std::ofstream(folder_ / name, std::ios::binary) << bytes;
    }
    json rawlog(const std::string& arguments, std::size_t at = 0) const {
        return json::parse(petal("inspect --json " + arguments).out).at("rawlogs").at(at);
    }
};

TEST_F(Inspect, TellsSensorsRatesAndIntrinsics) {
    Objects objects;
    for (int i = 0; i < 10; ++i) objects.push_back(cloud("LIDAR", 0.1 * i, 5));
    auto other = image("CAMERA", 0.5);
    other->cameraParams.ncols = 640;
    objects.push_back(other);
    write("a.rawlog", gzipped(bytes_of_objects(objects)));
    const Ended ended = petal("inspect a.rawlog");
    EXPECT_EQ(ended.exit_code, 0);
    EXPECT_THAT(ended.out,
                AllOf(HasSubstr("observations only"), HasSubstr("compressed from"),
                      HasSubstr("10 Hz"), HasSubstr("50, a message 5"), HasSubstr("60 x 40, grey"),
                      HasSubstr("fx 50"), HasSubstr("640 x 40 px")));
    const json told = rawlog("a.rawlog");
    EXPECT_EQ(told.at("whole"), true);
    EXPECT_EQ(told.at("layout"), "observations");
    EXPECT_EQ(told.at("sensors").at(0).at("label"), "CAMERA");
    EXPECT_EQ(told.at("sensors").at(0).at("images").at(0).at("size_mismatches"), 1);
    EXPECT_NEAR(told.at("sensors").at(1).at("rate_hz").get<double>(), 10.0, 1e-4);
    EXPECT_EQ(told.at("sensors").at(1).at("points").at("total"), 50);
    EXPECT_EQ(told.at("first_stamp"), "2023-11-14T22:13:20.000000Z");
}

TEST_F(Inspect, ShowsWhatWasReadBeforeItBroke) {
    const std::string bytes = bytes_of_objects({cloud("LIDAR", 0.0), cloud("LIDAR", 0.1)});
    write("cut.rawlog", bytes.substr(0, bytes.size() - 10));
    write("whole.rawlog", bytes);
    const Ended ended = petal("inspect cut.rawlog none.rawlog whole.rawlog");
    EXPECT_EQ(ended.exit_code, 1);
    EXPECT_THAT(ended.out, AllOf(HasSubstr("1 observation\n"), HasSubstr("2 observations")));
    EXPECT_THAT(ended.err, AllOf(HasSubstr("the file ends there"), HasSubstr("1 objects"),
                                 HasSubstr("none.rawlog does not exist")));
    EXPECT_EQ(rawlog("cut.rawlog whole.rawlog", 0).at("whole"), false);
    EXPECT_EQ(rawlog("cut.rawlog whole.rawlog", 1).at("whole"), true);
}

TEST_F(Inspect, LabelsCannotMoveTheCursor) {
    write("a.rawlog", bytes_of_objects({cloud("\x1B[2J\xFF", 0.0)}));
    EXPECT_THAT(petal("inspect a.rawlog").out, Not(HasSubstr("\x1B")));
    EXPECT_EQ(rawlog("a.rawlog").at("sensors").size(), 1U);
}

TEST_F(Inspect, UsageIsTwo) {
    EXPECT_EQ(petal("inspect").exit_code, 2);
    EXPECT_EQ(petal("inspect --yaml a.rawlog").exit_code, 2);
}

/// inspect at work on a rawlog that takes minutes: well compressed, some 9 GB of points.
class LongInspect : public Inspect {
   protected:
    void SetUp() override {
        Inspect::SetUp();
        std::string much;
        const std::string one = bytes_of_objects({cloud("LIDAR", 0.0, 2000)});
        while (much.size() < 30000000) much += one;
        const std::string member = gzipped(much);
        std::ofstream file(folder_ / "long.rawlog", std::ios::binary);
        for (int i = 0; i < 300; ++i) file << member;
        file.close();
        child_ = std::make_unique<PetalChild>(std::vector<std::string>{"inspect", "long.rawlog"},
                                              PetalChild::Options{folder_});
        ASSERT_TRUE(PetalChild::until(30.0, [&] { return child_->catches(SIGTERM); }));
    }

    std::unique_ptr<PetalChild> child_;
};

TEST_F(LongInspect, AnInterruptEndsItWith130) {
    child_->send(SIGINT);
    EXPECT_EQ(child_->wait(10.0), 130);
    EXPECT_EQ(read_text(folder_ / ".stderr"), "cancelled\n");
}

TEST_F(LongInspect, ASecondSignalEndsItAtOnceWith130Too) {
    child_->send(SIGSTOP);  // so that both come before it goes on
    child_->send(SIGINT);
    child_->send(SIGTERM);
    child_->send(SIGCONT);
    EXPECT_EQ(child_->wait(10.0), 130);
    EXPECT_EQ(read_text(folder_ / ".stderr"), "") << "it did not come to its own end";
}

TEST_F(Inspect, AllRealRawlogs) {
    PETAL_NEEDS_REAL_DATA();
    const std::string folder = (real_data() / "mrpt_rawlogs").string() + "/";
    for (const char* name : {"localization_demo", "rot_scan_2d", "rot_scan_velodyne",
                             "test_rtk_path", "test_velodyne_VLP16", "tests_rgbd"})
        EXPECT_EQ(petal("inspect " + folder + name + ".rawlog").exit_code, 0) << name;
    const json frames = rawlog(folder + "localization_demo.rawlog");
    EXPECT_EQ(frames.at("layout"), "sensory_frames");
    EXPECT_EQ(frames.at("actions").at("mrpt::obs::CActionRobotMovement2D"), 37);
    EXPECT_EQ(frames.at("sensors").at(0).at("points").at("total"), 13280);
    EXPECT_EQ(rawlog(folder + "test_rtk_path.rawlog").at("sensors").size(), 4U);
    EXPECT_THAT(rawlog(folder + "rot_scan_velodyne.rawlog").at("warnings").at(0).dump(),
                HasSubstr("16 rows"));
}

}  // namespace
}  // namespace petal::testing
