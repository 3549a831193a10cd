// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "runner.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <atomic>
#include <filesystem>
#include <fstream>

#include "petal/output.hpp"
#include "registry.hpp"
#include "runner_fakes.hpp"

namespace petal {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

class RunnerTest : public ::testing::Test {
   protected:
    void SetUp() override {
        std::string name = (fs::temp_directory_path() / "petal-runner-XXXXXX").string();
        ASSERT_NE(mkdtemp(name.data()), nullptr);
        folder_ = name;
        registry_.add(describe_stage<runner_fakes::Count>("fake.count"));
        registry_.add(describe_stage<runner_fakes::Affine>("fake.affine"));
        registry_.add(describe_stage<runner_fakes::Sum>("fake.sum"));
        registry_.add(describe_stage<runner_fakes::Dice>("fake.dice"));
        registry_.add(describe_stage<runner_fakes::List>("fake.list"));
        registry_.add(describe_stage<runner_fakes::Judge>("fake.judge"));
        registry_.add(describe_stage<runner_fakes::Bad>("fake.bad"));
    }
    void TearDown() override { fs::remove_all(folder_); }

    RunReport run(const std::string& stages, int threads = 2) {
        const fs::path file = folder_ / "p.json";
        write_file(file, R"({"petal": 1, "seed": 3, "stages": {)" + stages + "}}");
        PipelineRequest request;
        request.file = file;
        CheckedPipeline read = read_pipeline(request, registry_);
        for (const Problem& problem : read.problems) ADD_FAILURE() << to_string(problem);
        if (!read.pipeline) return {};
        RunSettings settings;
        settings.threads = threads;
        settings.folder = folder_ / "out";
        settings.cancel = &cancel_;
        RunLog log(settings.folder, Verbosity::quiet);
        return run_pipeline(*read.pipeline, settings, log);
    }

    static std::string list_of(const RunReport& report) {
        return report.notes.empty() ? "" : report.notes.front().note.nearest_miss;
    }

    fs::path folder_;
    Registry registry_;
    std::atomic<bool> cancel_{false};
};

// Two branches of one source, of different length, meet again by frame number.
const char* const kDiamond = R"(
    "a": {"type": "fake.count", "params": {"frames": 4}},
    "b": {"type": "fake.affine", "in": {"number": "a.number"}, "params": {"factor": 10}},
    "c": {"type": "fake.affine", "in": {"number": "b.number"}, "params": {"offset": 100}},
    "s": {"type": "fake.sum", "in": {"a": "a.number", "b": "c.number"}},
    "l": {"type": "fake.list", "in": {"numbers": "s.sum"}},
    "j": {"type": "fake.judge", "in": {"total": "l.total"}})";

TEST_F(RunnerTest, BranchesMeetByFrameAndGatheringSeesAllInOrder) {
    for (const int threads : {1, 2, 4}) {
        const RunReport report = run(kDiamond, threads);
        EXPECT_EQ(report.status, RunStatus::done);
        EXPECT_EQ(list_of(report), "f0=100 f1=111 f2=122 f3=133 ");
        ASSERT_THAT(report.verdicts, SizeIs(1));
        EXPECT_EQ(report.verdicts[0].stage, "j");
        EXPECT_THAT(report.verdicts[0].reasons, ElementsAre("total 466"));
        EXPECT_EQ(report.level(), std::optional<Level>(Level::usable));
        EXPECT_EQ(report.frames, 4U);
        EXPECT_EQ(report.stages.at("s").packets, 4U);
        EXPECT_EQ(report.stages.at("s").bytes, 4U * sizeof(runner_fakes::Number));
        EXPECT_EQ(report.stages.at("l").firings, 1U);
    }
}

TEST_F(RunnerTest, ManyFramesComeThroughOnAnyNumberOfThreads) {
    const std::string stages = R"(
        "a": {"type": "fake.count", "params": {"frames": 2000}},
        "d": {"type": "fake.dice", "in": {"number": "a.number"}},
        "e": {"type": "fake.dice", "in": {"number": "a.number"}},
        "s": {"type": "fake.sum", "in": {"a": "d.number", "b": "a.number"}},
        "l": {"type": "fake.list", "in": {"numbers": ["s.sum", "e.number"]}})";
    const std::string alone = list_of(run(stages, 1));
    EXPECT_EQ(std::count(alone.begin(), alone.end(), '='), 4000);
    EXPECT_EQ(list_of(run(stages, 4)), alone);
}

TEST_F(RunnerTest, EachStageAndFrameHasItsOwnRandomness) {
    const std::string stages = R"(
        "a": {"type": "fake.count", "params": {"frames": 2}},
        "d": {"type": "fake.dice", "in": {"number": "a.number"}},
        "e": {"type": "fake.dice", "in": {"number": "a.number"}},
        "l": {"type": "fake.list", "in": {"numbers": ["d.number", "e.number"]}})";
    const std::string text = list_of(run(stages));
    std::vector<std::string> numbers;
    for (std::size_t at = text.find('='); at != std::string::npos; at = text.find('=', at + 1))
        numbers.push_back(text.substr(at + 1, text.find(' ', at) - at - 1));
    ASSERT_THAT(numbers, SizeIs(4));
    std::sort(numbers.begin(), numbers.end());
    EXPECT_EQ(std::adjacent_find(numbers.begin(), numbers.end()), numbers.end());
}

TEST_F(RunnerTest, NoFrameStillEndsOrderly) {
    const RunReport report = run(R"(
        "a": {"type": "fake.count", "params": {"frames": 0}},
        "b": {"type": "fake.affine", "in": {"number": "a.number"}},
        "l": {"type": "fake.list", "in": {"numbers": "b.number"}},
        "j": {"type": "fake.judge", "in": {"total": "l.total"}})");
    EXPECT_EQ(report.status, RunStatus::done);
    EXPECT_EQ(report.stages.at("j").firings, 1U);
    EXPECT_EQ(report.stages.at("b").firings, 0U);
}

TEST_F(RunnerTest, AnErrorNamesStageTypeAndFrame) {
    const RunReport report = run(R"(
        "a": {"type": "fake.count"},
        "b": {"type": "fake.affine", "in": {"number": "a.number"}, "params": {"fail_at": 2}},
        "l": {"type": "fake.list", "in": {"numbers": "b.number"}})");
    EXPECT_EQ(report.status, RunStatus::failed);
    EXPECT_THAT(report.errors,
                ElementsAre("b (fake.affine), frame 2 'f2': this number is not liked"));
    EXPECT_EQ(report.stages.at("l").firings, 0U) << "nothing downstream finishes after an error";
}

// More frames than may be in flight: a source must not wait for ever for a shorter one.
TEST_F(RunnerTest, SourcesOfDifferentLengthThatMeetAreAnError) {
    for (const int threads : {1, 4}) {
        const RunReport report = run(R"(
            "a": {"type": "fake.count", "params": {"frames": 50}},
            "b": {"type": "fake.count", "params": {"frames": 2}},
            "s": {"type": "fake.sum", "in": {"a": "a.number", "b": "b.number"}})",
                                     threads);
        EXPECT_EQ(report.status, RunStatus::failed);
        ASSERT_THAT(report.errors, SizeIs(1));
        EXPECT_THAT(report.errors[0], HasSubstr("b.number ended after 2, a.number goes on"));
        EXPECT_EQ(report.level(), std::nullopt);
    }
}

TEST_F(RunnerTest, SourcesOfDifferentLengthThatDoNotMeetBothComeToTheirEnd) {
    for (const int threads : {1, 4}) {
        const RunReport report = run(R"(
            "a": {"type": "fake.count", "params": {"frames": 50}},
            "b": {"type": "fake.count", "params": {"frames": 1}},
            "c": {"type": "fake.affine", "in": {"number": "a.number"}},
            "d": {"type": "fake.affine", "in": {"number": "b.number"}},
            "l": {"type": "fake.list", "in": {"numbers": ["c.number", "d.number"]}})",
                                     threads);
        EXPECT_EQ(report.status, RunStatus::done);
        EXPECT_EQ(report.stages.at("c").packets, 50U);
        EXPECT_EQ(report.stages.at("d").packets, 1U);
        EXPECT_EQ(report.stages.at("l").firings, 1U);
    }
}

TEST_F(RunnerTest, BrokenContractsAreNamed) {
    const auto error_of = [this](const std::string& how) {
        const RunReport report = run(R"("a": {"type": "fake.count"},
            "b": {"type": "fake.bad", "in": {"number": "a.number"}, "params": {"how": ")" +
                                     how + "\"}}");
        return report.errors.empty() ? std::string("no error") : report.errors.front();
    };
    EXPECT_THAT(error_of("nothing"), HasSubstr("wrote no packet on port 'number'"));
    EXPECT_THAT(error_of("twice"), HasSubstr("wrote port 'number' twice"));
    EXPECT_THAT(error_of("unknown_port"), HasSubstr("port 'numbers', which it does not declare"));
    EXPECT_THAT(error_of("throws_int"), HasSubstr("no std::exception"));
    EXPECT_THAT(error_of("ends"), HasSubstr("end_of_data() is for sources"));
}

TEST_F(RunnerTest, CancelledBeforeItStartsFiresNothing) {
    cancel_ = true;
    const RunReport report = run(kDiamond);
    EXPECT_EQ(report.status, RunStatus::cancelled);
    for (const auto& [id, statistics] : report.stages) EXPECT_EQ(statistics.firings, 0U) << id;
}

}  // namespace
}  // namespace petal
