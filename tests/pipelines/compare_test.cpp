// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include <gmock/gmock.h>

#include <algorithm>
#include <random>

#include "petal_child.hpp"
#include "petal_process.hpp"

namespace petal::testing {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

/// Comparisons of stages that draw a number and write it (plugins/unsure.cpp).
class Compare : public PetalProcess {
   protected:
    void SetUp() override {
        PetalProcess::SetUp();
        write("p.json", R"({"petal": 1, "stages": {
  "draw": {"type": "unsure.draw"},
  "result": {"type": "unsure.result", "in": {"value": "draw.value"}}}})");
    }
    void write(const std::string& name, const std::string& text) const {
        std::ofstream(folder_ / name) << text;
    }
    /// c.json with these variants and more members.
    void write_comparison(const std::string& variants, const std::string& more = "") const {
        write("c.json", R"({"petal_compare": 1, "base": "p.json",
  "variants": {)" + variants +
                            R"(},
  "seeds": "1..12", "metrics": {"value": {"unit": "m", "better": "lower"}})" +
                            more + "}\n");
    }
    Ended compare(const std::string& arguments) const {
        return petal("--plugin-path '" PETAL_UNSURE_PLUGINS "' compare " + arguments);
    }
    json read_json(const std::string& name) const {
        return json::parse(read_text(folder_ / name), nullptr, false);
    }
    std::unique_ptr<PetalChild> start(const std::vector<std::string>& more,
                                      rlim_t largest_file = RLIM_INFINITY) const {
        std::vector<std::string> words{"--plugin-path", PETAL_UNSURE_PLUGINS, "compare", "c.json"};
        words.insert(words.end(), more.begin(), more.end());
        return std::make_unique<PetalChild>(words, PetalChild::Options{folder_, -1, largest_file});
    }
    std::size_t units(const std::string& out) const {
        std::size_t count = 0;
        std::error_code none;
        for (const auto& entry : fs::directory_iterator(folder_ / out / "units", none))
            count += entry.path().filename().string()[0] == '.' ? 0U : 1U;
        return count;
    }
};

TEST_F(Compare, TellsWhichIsBetterAndWritesItDown) {
    write_comparison(R"("a": {}, "half": {"set": {"result.factor": 0.5}},
                        "fails": {"set": {"result.below": 2, "result.does": "throws"}})");
    const Ended ended = compare("c.json --out out --timing 2");
    ASSERT_EQ(ended.exit_code, 0) << ended.err;
    EXPECT_THAT(ended.out, HasSubstr("value (m), lower is better"));
    EXPECT_THAT(ended.err, HasSubstr("failed: fails, pipeline, seed 1: error: result "
                                     "(unsure.result): a number that is too small"));
    const json told = read_json("out/compare.json");
    const json& variants = told["metrics"][0]["variants"];
    EXPECT_EQ(variants["half"]["to_reference"]["verdict"], "better");
    EXPECT_EQ(variants["fails"]["to_reference"]["verdict"], "worse");
    EXPECT_EQ(variants["fails"]["to_reference"]["median_difference"]["value"], "inf");
    EXPECT_EQ(told["failures"]["fails"]["by_cause"]["error"], 12);
    EXPECT_EQ(told["failures"]["fails"]["to_reference"]["verdict"], "worse");
    EXPECT_EQ(told["failed_units"].size(), 12U);
    const std::string csv = read_text(folder_ / "out" / "metrics" / "value.csv");
    EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 37);
    EXPECT_THAT(csv, HasSubstr("\npipeline,3,fails,error,,0."));
    const json run = read_json("out/run.json");
    EXPECT_EQ(run["status"], "done");
    EXPECT_EQ(run["stages"]["by_id"]["draw"]["executed"], 12);
    EXPECT_EQ(run["stages"]["by_id"]["draw"]["shared"], 24);
    EXPECT_EQ(run["stages"]["executed"], 48);
    const json timing = read_json("out/timing.json");
    EXPECT_EQ(timing["variants"]["half"]["units"], 2);
    EXPECT_EQ(timing["variants"]["fails"]["failed"], 2);
    EXPECT_GT(timing["variants"]["a"]["median_wall_s"].get<double>(), 0.0);

    const Ended again = compare("c.json --out again --no-sharing --jobs 1");
    ASSERT_EQ(again.exit_code, 0) << again.err;
    EXPECT_TRUE(read_text(folder_ / "out/compare.json") ==
                read_text(folder_ / "again/compare.json"));
    EXPECT_EQ(read_json("again/run.json")["stages"]["shared"], 0);
}

TEST_F(Compare, AVariantThatCrashesTakesNothingAlong) {
    write_comparison(R"("a": {},
        "aborts": {"set": {"result.below": 0.5, "result.does": "aborts"}},
        "exits": {"set": {"result.below": 0.5, "result.does": "exits"}},
        "is_killed": {"set": {"result.below": 0.5, "result.does": "is_killed"}}, "b": {"set": {"result.factor": 2}})");
    const Ended ended = compare("c.json --out out");
    ASSERT_EQ(ended.exit_code, 0) << ended.err;
    const json told = read_json("out/compare.json");
    const int crashes = told["failures"]["aborts"]["failed"].get<int>();
    EXPECT_GT(crashes, 0);
    EXPECT_LT(crashes, 12);
    for (const char* name : {"aborts", "exits", "is_killed"})
        EXPECT_EQ(told["failures"][name]["by_cause"]["crash"], crashes) << name;
    EXPECT_EQ(told["failures"]["b"]["failed"], 0);
    std::string reasons;
    for (const json& unit : told["failed_units"])
        reasons += unit["reason"].get<std::string>() + "\n";
    EXPECT_THAT(reasons, HasSubstr("signal 6 (Aborted)"));
    EXPECT_THAT(reasons, HasSubstr("ended the program with exit code 0"));
    EXPECT_THAT(reasons, HasSubstr("signal 9 (Killed), twice; out of memory?"));
}

TEST_F(Compare, GoesOnAfterItWasKilledAtAnyMoment) {
    write_comparison(R"("a": {"set": {"draw.pause_ms": 20}}, "b": {"set": {"result.pause_ms": 15}},
                        "c": {"set": {"result.below": 0.3, "result.does": "throws"}})");
    ASSERT_EQ(compare("c.json --out whole").exit_code, 0);
    std::mt19937 rng(4);
    int kills = 0;
    for (int i = 0; i < 4; ++i) {
        const auto child = start({"--out", "out"});
        // From before the first unit to about the last one.
        const std::size_t at = units("out") + rng() % 12;
        PetalChild::until(20.0, [&] {
            return units("out") >= at || fs::exists(folder_ / "out" / "compare.json");
        });
        child->send(SIGKILL);
        kills += child->wait(20.0) == 1000 + SIGKILL ? 1 : 0;
    }
    EXPECT_GE(kills, 2) << "the others had come to their end";
    const Ended ended = compare("c.json --out out");
    ASSERT_EQ(ended.exit_code, 0) << ended.err;
    EXPECT_TRUE(read_text(folder_ / "whole/compare.json") ==
                read_text(folder_ / "out/compare.json"));
    EXPECT_FALSE(fs::exists(folder_ / "out" / "work"));
    const json run = read_json("out/run.json");
    EXPECT_EQ(run["units"]["different"], 36);
}

TEST_F(Compare, CancelledItEndsWith130AndGoesOn) {
    write_comparison(R"("a": {"set": {"draw.pause_ms": 100}}, "b": {"set": {"result.factor": 2}})");
    const auto child = start({"--out", "out"});
    ASSERT_TRUE(PetalChild::until(30.0, [&] { return units("out") > 0; }));
    child->send(SIGINT);
    EXPECT_EQ(child->wait(10.0), 130);
    EXPECT_EQ(read_json("out/run.json")["status"], "cancelled");
    EXPECT_FALSE(fs::exists(folder_ / "out" / "compare.json"));
    ASSERT_EQ(compare("c.json --out out").exit_code, 0);
    const json run = read_json("out/run.json");
    EXPECT_GT(run["units"]["found_finished"], 0);
    EXPECT_EQ(run["units"]["different"], 24);
}

TEST_F(Compare, ADamagedUnitIsToldAndRunAgain) {
    write_comparison(R"("a": {}, "b": {"set": {"result.factor": 2}})");
    ASSERT_EQ(compare("c.json --out out").exit_code, 0);
    const std::string before = read_text(folder_ / "out/compare.json");
    const fs::path unit = fs::directory_iterator(folder_ / "out" / "units")->path();
    fs::resize_file(unit / "result.json", 5);
    const Ended ended = compare("c.json --out out");
    EXPECT_EQ(ended.exit_code, 0) << ended.err;
    EXPECT_THAT(ended.err, HasSubstr("damaged, so it is run again: "));
    EXPECT_THAT(ended.err, HasSubstr("result.json is not what the unit wrote"));
    EXPECT_EQ(read_json("out/run.json")["units"]["run_now"], 1);
    EXPECT_TRUE(before == read_text(folder_ / "out/compare.json"));
}

TEST_F(Compare, AFullDiskStopsItAndIsNoFailureOfAUnit) {
    write_comparison(R"("a": {})");
    const auto child = start({"--out", "out"}, 300);  // bytes a file
    EXPECT_EQ(child->wait(30.0), 1) << read_text(folder_ / ".stderr");
    EXPECT_THAT(read_text(folder_ / ".stderr"), HasSubstr("cannot write"));
    EXPECT_EQ(units("out"), 0U);
    EXPECT_EQ(compare("c.json --out out").exit_code, 0);
}

TEST_F(Compare, MoreSeedsAndVariantsUseWhatIsThere) {
    write_comparison(R"("a": {}, "b": {"set": {"result.factor": 2}})");
    ASSERT_EQ(compare("c.json --out out --seeds 1..5 --only b").exit_code, 0);
    ASSERT_EQ(compare("c.json --out out").exit_code, 0);
    const json run = read_json("out/run.json");
    EXPECT_EQ(run["units"]["found_finished"], 10);
    EXPECT_EQ(run["units"]["run_now"], 14);
}

TEST_F(Compare, AFolderOfAnotherComparisonIsRefused) {
    write_comparison(R"("a": {})");
    ASSERT_EQ(compare("c.json --out out").exit_code, 0);
    fs::copy(folder_ / "c.json", folder_ / "d.json");
    const Ended other = compare("d.json --out out");
    EXPECT_EQ(other.exit_code, 2);
    EXPECT_THAT(other.err, HasSubstr("holds the comparison 'c', not 'd'"));
    fs::create_directories(folder_ / "mine");
    write("mine/precious", "x");
    EXPECT_THAT(compare("c.json --out mine").err, HasSubstr("no comparison's"));
    write("mine/run.json", R"({"petal_run": 1})");
    EXPECT_THAT(compare("c.json --out mine").err, HasSubstr("no comparison's"));
    EXPECT_THAT(compare("c.json --out c.json").err, HasSubstr("is a file"));
    EXPECT_THAT(compare("c.json --out .").err, HasSubstr("is the working folder"));
    fs::create_directories(folder_ / "data");
    EXPECT_THAT(compare("c.json --out data/out --data data").err, HasSubstr("lies in the data"));
}

TEST_F(Compare, OnlyOneAtATimeHasTheFolder) {
    write_comparison(R"("a": {"set": {"draw.pause_ms": 60000}})");
    const auto child = start({"--out", "out"});
    ASSERT_TRUE(PetalChild::until(30.0, [&] { return fs::exists(folder_ / "out" / "run.json"); }));
    const Ended ended = compare("c.json --out out");
    EXPECT_EQ(ended.exit_code, 2);
    EXPECT_THAT(ended.err, HasSubstr("is in use"));
}

TEST_F(Compare, AMetricThatNoResultHasIsToldWithTheNearest) {
    write_comparison(R"("a": {"set": {"draw.pause_ms": 50}})");
    const Ended ended = compare("c.json --out out --metric valeu:lower");
    EXPECT_EQ(ended.exit_code, 2);
    EXPECT_THAT(ended.err, HasSubstr("no result has a number for the metric 'valeu'"));
    EXPECT_THAT(ended.err, HasSubstr("did you mean 'value'?"));
    EXPECT_LT(units("out"), 12U) << "told early";
    EXPECT_EQ(compare("c.json --out out --metric /twice/0:higher").exit_code, 0);
    EXPECT_TRUE(fs::exists(folder_ / "out" / "metrics" / "_twice_0.csv"));
}

TEST_F(Compare, WhereAllFailNothingWasCompared) {
    write_comparison(R"("a": {"set": {"result.below": 2, "result.does": "throws"}})");
    const Ended ended = compare("c.json --out out");
    EXPECT_EQ(ended.exit_code, 1);
    EXPECT_THAT(ended.err, HasSubstr("every unit failed"));
}

TEST_F(Compare, TheQuickFormComparesPipelines) {
    write("q.json", R"({"petal": 1, "stages": {
  "draw": {"type": "unsure.draw"},
  "result": {"type": "unsure.result", "in": {"value": "draw.value"}, "params": {"factor": 3}}}})");
    Ended ended = compare("p.json q.json --seeds 1..8 --metric value:lower:0.001 --out out");
    EXPECT_EQ(ended.exit_code, 0) << ended.err;
    EXPECT_THAT(ended.out, HasSubstr("worse"));
    EXPECT_EQ(read_json("out/compare.json")["name"], "p-q");
    EXPECT_EQ(read_json("out/run.json")["stages"]["by_id"]["draw"]["shared"], 8);
    ended = compare("p.json q.json --seeds 1..8 --out out");
    EXPECT_EQ(ended.exit_code, 0) << ended.err;
    EXPECT_THAT(ended.out, HasSubstr("differs"));
}

TEST_F(Compare, ASweepTellsTheSensitivity) {
    write_comparison(R"("a": {})", R"(, "sweep": {"result.factor": [0.5, 1, 2]})");
    const Ended ended = compare("c.json --out out");
    EXPECT_EQ(ended.exit_code, 0) << ended.err;
    EXPECT_THAT(ended.out, HasSubstr("sensitivity to result.factor (medians)"));
    const json told = read_json("out/compare.json");
    const json& sweep = told["sweeps"]["result.factor"];
    ASSERT_EQ(sweep.size(), 3U);
    EXPECT_DOUBLE_EQ(sweep[2]["median"]["value"]["value"].get<double>(),
                     4.0 * sweep[0]["median"]["value"]["value"].get<double>());
    EXPECT_EQ(read_json("out/run.json")["units"]["different"], 36) << "1 is the base itself";
}

TEST_F(Compare, CheckTellsWhatIsWrongAndRunsNothing) {
    write_comparison(R"("a": {}, "b": {"set": {"result.facter": 2}})");
    const Ended ended = compare("c.json --check --out out");
    EXPECT_EQ(ended.exit_code, 2);
    EXPECT_THAT(ended.err, HasSubstr("c.json:2: stages.result.params.facter"));
    EXPECT_THAT(ended.err, HasSubstr("did you mean 'factor'?"));
    EXPECT_FALSE(fs::exists(folder_ / "out"));
    write_comparison(R"("a": {})");
    EXPECT_THAT(compare("c.json --check").out, HasSubstr("12 units, no problem found"));
}

/// The comparisons that petal ships, on a small scene.
class ShippedComparison : public PetalProcess, public ::testing::WithParamInterface<const char*> {};

TEST_P(ShippedComparison, RunsSmall) {
    const std::string scene = PETAL_SOURCE_DIR "/tests/data/small_scene.json";
    const Ended ended =
        petal("compare " + pipeline("compare/" + std::string(GetParam()) + ".json") +
              " --seeds 1..2 --set 'scene.scenes=[\"" + scene +
              "\"]' --set scene.duration=0.6 --out out");
    // On so few points a board may not be found at all: then every unit failed, which is told.
    EXPECT_THAT(ended.exit_code, ::testing::AnyOf(0, 1)) << ended.err;
    EXPECT_THAT(ended.err, Not(HasSubstr("crash"))) << ended.err;
    EXPECT_THAT(ended.err, Not(HasSubstr(": error: "))) << ended.err;
    const json told = json::parse(read_text(folder_ / "out" / "compare.json"));
    for (const auto& [name, variant] : told["failures"].items())
        EXPECT_GT(variant["units"], 0) << name;
}

INSTANTIATE_TEST_SUITE_P(Files, ShippedComparison,
                         ::testing::Values("image_detectors", "letter_vs_calibrate",
                                           "outlier_removers", "solvers", "table2"),
                         [](const auto& one) { return std::string(one.param); });

}  // namespace
}  // namespace petal::testing
