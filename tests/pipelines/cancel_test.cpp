// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "slow_runs.hpp"

namespace petal::testing {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

// All of these would take a minute or more. A second is promised; the bound is generous because
// other work may have the machine.
constexpr double kSoon = 10.0;  // s

struct Case {
    const char* name;
    std::string source;
    std::string work;
    std::string writer;
    const char* begun;  ///< the file that shows that the slow part is at work
    std::vector<std::string> options;
};

std::vector<Case> cases() {
    const std::string many = R"("frames": 100000, "pause_ms": 1)";
    const std::string quick = R"("frames": 3)";
    return {
        {"source", R"("frames": 5, "pause_ms": 60000)", "", "", "out/.log.part.txt", {}},
        {"many_frames", many, "", "", "out/.log.part.txt", {}},
        {"loop_that_polls", quick, R"("work_ms": 60000)", "", "out/.log.part.txt", {}},
        {"finish", quick, R"("in": "finish", "work_ms": 60000)", "", "out/.log.part.txt", {}},
        {"writing", quick, "", R"("bytes": 100000, "pause_ms": 600)", "out/.result.part.json", {}},
        {"streaming",
         quick,
         "",
         R"("way": "stream", "bytes": 100000, "pause_ms": 600)",
         "out/.result.part.json",
         {}},
        {"saving",
         quick,
         "",
         R"("way": "save", "bytes": 100000, "pause_ms": 600)",
         "out/stages/writer/.result.part.json",
         {}},
        {"source_that_does_not_poll",
         R"("frames": 5, "pause_ms": 60000, "polls": false)",
         "",
         "",
         "out/.log.part.txt",
         {}},
        {"stage_that_does_not_poll",
         quick,
         R"("work_ms": 60000, "polls": false)",
         "",
         "out/.log.part.txt",
         {}},
        {"many_threads", many, R"("work_ms": 5)", "", "out/.log.part.txt", {"--threads", "16"}},
        {"one_thread", many, R"("work_ms": 5)", "", "out/.log.part.txt", {"--threads", "1"}},
    };
}

class CancelTest : public SlowRuns, public ::testing::WithParamInterface<Case> {};

TEST_P(CancelTest, EndsSoonWithCode130AndWithoutAProduct) {
    for (const int signal : {SIGINT, SIGTERM}) {
        fs::remove_all(folder_ / "out");
        write_pipeline(GetParam().source, GetParam().work, GetParam().writer);
        const auto child = start(GetParam().options);
        ASSERT_TRUE(appears(GetParam().begun)) << err();
        std::this_thread::sleep_for(std::chrono::milliseconds(50));  // into the slow part
        child->send(signal);
        EXPECT_EQ(child->wait(kSoon), 130) << err();
        EXPECT_EQ(run_json().value("status", ""), "cancelled");
        for (const std::string& file : files())
            EXPECT_TRUE(file == "run.json" || file == "log.txt") << file << " was left";
    }
}

INSTANTIATE_TEST_SUITE_P(Everywhere, CancelTest, ::testing::ValuesIn(cases()),
                         [](const auto& which) { return std::string(which.param.name); });

class Cancel : public SlowRuns {};

TEST_F(Cancel, AStageThatDidNotStopIsNamed) {
    write_pipeline(R"("frames": 1)", R"("work_ms": 60000, "polls": false)", "");
    const auto child = start();
    ASSERT_TRUE(appears("out/.log.part.txt"));
    // The guard learns a few times a second who is at work.
    std::this_thread::sleep_for(std::chrono::milliseconds(600));
    child->send(SIGINT);
    EXPECT_EQ(child->wait(kSoon), 130);
    EXPECT_THAT(err(), HasSubstr("at work in work"));
    EXPECT_THAT(run_json()["errors"].dump(), HasSubstr("at work in work"));
}

TEST_F(Cancel, WhilePluginsLoadNothingIsLeft) {
    write_pipeline("", "", "");
    const auto child = start({}, RLIM_INFINITY, -1, "60");
    ASSERT_TRUE(PetalChild::until(30.0, [&] { return child->catches(SIGTERM); }));
    child->send(SIGTERM);
    EXPECT_EQ(child->wait(kSoon), 130);
    EXPECT_FALSE(fs::exists(folder_ / "out"));
}

TEST_F(Cancel, ASecondSignalEndsTheProgramAtOnce) {
    write_pipeline(R"("frames": 1)", R"("work_ms": 60000, "polls": false)", "");
    const auto child = start();
    ASSERT_TRUE(appears("out/.log.part.txt"));
    child->send(SIGINT);
    child->send(SIGTERM);
    EXPECT_EQ(child->wait(kSoon), 130);
    EXPECT_FALSE(fs::exists(folder_ / "out" / "result.json"));
}

TEST_F(Cancel, ARunThatIsKilledLeavesNothingThatLooksWholeAndForceTidiesIt) {
    write_pipeline(R"("frames": 3)", "", R"("bytes": 100000, "pause_ms": 600)");
    {
        const auto child = start();
        ASSERT_TRUE(appears("out/.result.part.json"));
        child->send(SIGKILL);
        EXPECT_EQ(child->wait(kSoon), 1000 + SIGKILL);
    }
    EXPECT_EQ(run_json().value("status", ""), "running");
    EXPECT_THAT(files(), ElementsAre(".log.part.txt", ".result.part.json", "run.json"));
    write_pipeline(R"("frames": 3)", "", R"("name": "other.txt")");
    EXPECT_EQ(start()->wait(60.0), 2) << "it holds a run";
    EXPECT_EQ(start({"--force"})->wait(60.0), 0) << err();
    EXPECT_THAT(files(), ElementsAre("log.txt", "other.txt", "run.json"));
    EXPECT_EQ(run_json().value("status", ""), "done");
}

// A product that was whole before the run was killed: the run does not count as done, and --force
// knows what to replace, also in folders.
TEST_F(Cancel, ForceTidiesTheWholeProductsOfAKilledRunToo) {
    std::ofstream(folder_ / "p.json") << R"({"petal": 1, "stages": {
  "ticks": {"type": "slow.source"},
  "early": {"type": "slow.writer", "in": {"tick": "ticks.tick"}, "params": {"name": "sub/early.json"}},
  "late": {"type": "slow.writer", "in": {"tick": "ticks.tick"},
           "params": {"name": "sub/late.json", "bytes": 100000, "pause_ms": 600}}}})";
    {
        const auto child = start({"--threads", "2"});
        ASSERT_TRUE(appears("out/sub/early.json"));
        ASSERT_TRUE(appears("out/sub/.late.part.json"));
        child->send(SIGKILL);
        child->wait(kSoon);
    }
    EXPECT_EQ(run_json().value("status", ""), "running");
    write_pipeline("", "", "");
    EXPECT_EQ(start({"--force"})->wait(60.0), 0) << err();
    EXPECT_THAT(files(), ElementsAre("log.txt", "result.json", "run.json"));
}

}  // namespace
}  // namespace petal::testing
