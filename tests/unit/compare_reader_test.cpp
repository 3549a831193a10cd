// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include <gmock/gmock.h>

#include "comparison_reader.hpp"
#include "host_errors.hpp"
#include "seed_range.hpp"
#include "selection.hpp"

namespace petal::compare {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

std::vector<std::uint64_t> seeds(const std::string& text) {
    std::string why;
    auto read = read_seeds(text, why);
    EXPECT_EQ(read.empty(), !why.empty()) << why;
    return read;
}

TEST(SeedRange, ReadsRangesAndLists) {
    EXPECT_THAT(seeds("3"), ElementsAre(3));
    EXPECT_THAT(seeds("1..4"), ElementsAre(1, 2, 3, 4));
    EXPECT_THAT(seeds("7,1..2"), ElementsAre(7, 1, 2));
    EXPECT_THAT(seeds("18446744073709551615..18446744073709551615"),
                ElementsAre(18446744073709551615U));
}

TEST(SeedRange, SaysWhatIsWrong) {
    for (const auto& [text, told] :
         std::map<std::string, std::string>{{"", "is no seed range"},
                                            {"1..", "is no seed range"},
                                            {"a..3", "is no seed range"},
                                            {"1...3", "is no seed range"},
                                            {"-1", "is no seed range"},
                                            {"1,,2", "is no seed range"},
                                            {"5..1", "runs backwards"},
                                            {"1..3,2", "a seed twice"},
                                            {"1..1000000", "more than 1000"},
                                            {"0..99999,200000", "more than 1000"}}) {
        std::string why;
        EXPECT_THAT(read_seeds(text, why), IsEmpty()) << text;
        EXPECT_THAT(why, HasSubstr(told)) << text;
    }
}

Comparison comparison_of(const std::string& text) {
    auto checked = read_comparison_text(text, "dir/c.json");
    for (const Problem& problem : checked.problems) ADD_FAILURE() << to_string(problem);
    return checked.comparison.value();
}

std::string problems_of(const std::string& text) {
    const auto checked = read_comparison_text(text, "dir/c.json");
    EXPECT_EQ(checked.comparison.has_value(), checked.problems.empty());
    std::string all;
    for (const Problem& problem : checked.problems) all += to_string(problem) + "\n";
    return all;
}

const char* const kWholeComparison = R"({
  "$schema": "x", "petal_compare": 1, "about": "a test",
  "base": "../letter.json",
  "patch": { "stages": { "overlay": null } },
  "variants": {
    "a": { "about": "the base" },
    "b": { "with": ["v/one.json", "two.json"], "patch": { "stages": {} }, "set": { "s.p": 3, "s.q": "x" } },
    "c": { "pipeline": "other.json", "with": "v/one.json" }
  },
  "reference": "b",
  "sweep": { "s.p": [0.10, 2], "s.l": [[1, "x"], true] },
  "data": { "sim": { "set": { "s.n": 1 } }, "real": { "folder": "${env:X}/y", "seeds": [4, 5] } },
  "seeds": "1..3",
  "metrics": {
    "m.one": { "unit": "deg", "better": "lower", "margin": 0.5 },
    "/a/0": { "better": "higher", "margin_share": 0.1 },
    "m.two": { "better": "none" }
  },
  "seed": 9, "confidence": 0.9, "failure": "weak", "failure_margin": 0.05
})";

TEST(ComparisonReader, ReadsAllOfIt) {
    const Comparison c = comparison_of(kWholeComparison);
    EXPECT_EQ(c.name, "c");
    ASSERT_EQ(c.variants.size(), 7U);
    EXPECT_EQ(c.reference, 1U);
    EXPECT_EQ(c.variants[0].pipeline, "letter.json");
    EXPECT_EQ(c.variants[0].base_changes.size(), 1U);
    ASSERT_EQ(c.variants[1].changes.size(), 5U);
    EXPECT_EQ(c.variants[1].changes[0].file, "dir/v/one.json");
    EXPECT_TRUE(c.variants[1].changes[2].patch);
    EXPECT_EQ(c.variants[2].pipeline, "dir/other.json");
    EXPECT_THAT(c.variants[2].base_changes, IsEmpty()) << "they are the base's";
    EXPECT_EQ(c.variants[3].name, "s.p=0.10");
    EXPECT_EQ(c.variants[3].changes.size(), 6U) << "on top of the reference";
    EXPECT_EQ(c.variants[5].name, "s.l=[1,\"x\"]");
    EXPECT_EQ(c.variants[6].swept->value, "true");
    ASSERT_EQ(c.data.size(), 2U);
    EXPECT_THAT(c.seeds_of(c.data[0]), ElementsAre(1, 2, 3));
    EXPECT_THAT(c.seeds_of(c.data[1]), ElementsAre(4, 5));
    EXPECT_EQ(c.data[1].folder, "${env:X}/y");
    ASSERT_EQ(c.metrics.size(), 3U);
    EXPECT_EQ(c.metrics[0].better, Direction::lower);
    EXPECT_EQ(c.metrics[0].margin, 0.5);
    EXPECT_TRUE(c.metrics[1].margin_is_share);
    EXPECT_EQ(c.seed, 9U);
    EXPECT_EQ(c.confidence, 0.9);
    EXPECT_EQ(c.fails_on, FailsOn::weak);
    EXPECT_EQ(c.failure_margin, 0.05);
}

TEST(ComparisonReader, HasDefaults) {
    const Comparison c = comparison_of(
        R"({"petal_compare": 1, "base": "p.json", "metrics": {"m": {"better": "lower"}}})");
    ASSERT_EQ(c.variants.size(), 1U);
    EXPECT_EQ(c.variants[0].name, "base");
    ASSERT_EQ(c.data.size(), 1U);
    EXPECT_THAT(c.seeds, ElementsAre(1));
    EXPECT_EQ(c.fails_on, FailsOn::not_usable);
}

TEST(ComparisonReader, TellsAllThatIsWrongAtOnce) {
    const std::string told = problems_of(R"({
  "petal_compare": 2,
  "bass": "p.json",
  "variants": { "a b": { "pipeline": "" }, "v": { "patsh": {} }, "w": 3 },
  "reference": "u",
  "sweep": { "s": [1], "s.p": 4 },
  "data": { "d": { "folder": 1, "seeds": "5..1" }, "e": { "with": [2], "set": { "x": 1 } } },
  "seeds": [1, -2],
  "metrics": { "m": { "beter": "lower", "margin": -1 },
               "n": { "better": "smaller", "margin": 1, "margin_share": 0.1 } },
  "confidence": 2, "failure": "never", "seed": "x"
})");
    for (const char* part :
         {"dir/c.json:2: petal_compare: unknown format version: 2; expected",
          "dir/c.json:3: bass: unknown key 'bass' in a comparison; expected one of",
          "did you mean 'base'?",
          "'a b' is no name",
          "did you mean 'patch'?",
          "variants.w: 3 is no object",
          "reference: no variant 'u'",
          "sweep.s: 's' names no parameter",
          "dir/c.json:6: sweep[\"s.p\"]: 4 is no range",
          "data.d.folder: 1 is no text",
          "data.d.seeds: '5..1' runs backwards",
          "data.e.with: 2 is no file",
          "data.e.set.x: 'x' names no parameter",
          "seeds: -2 is no seed",
          "metrics.m.beter: unknown key",
          "did you mean 'better'?",
          "metrics.m.better: missing",
          "metrics.m.margin: -1 is out of range; expected 0 or more",
          "metrics.n.better: 'smaller' is unknown; expected one of lower, higher, none",
          "metrics.n.margin_share: stands beside margin",
          "confidence: 2 is out of range",
          "failure: 'never' is unknown",
          "seed: the string 'x' is no seed"})
        EXPECT_THAT(told, HasSubstr(part));
}

TEST(ComparisonReader, TellsWhatIsMissing) {
    EXPECT_THAT(problems_of("{}"), HasSubstr("petal_compare: missing; expected"));
    EXPECT_THAT(problems_of("{}"), HasSubstr("variants: none, and no base"));
    EXPECT_THAT(problems_of("{}"), HasSubstr("metrics: none; expected"));
    EXPECT_THAT(problems_of("[]"), HasSubstr("a list is no object"));
    EXPECT_THAT(problems_of("{"), HasSubstr("syntax error"));
    EXPECT_THAT(problems_of(R"({"petal_compare": 1, "variants": {"v": {}}, "metrics": {}})"),
                HasSubstr("variants.v.pipeline: missing, and the comparison has no base"));
    const auto absent = read_comparison("/nowhere/c.json");
    ASSERT_EQ(absent.problems.size(), 1U);
    EXPECT_THAT(to_string(absent.problems[0]), HasSubstr("/nowhere/c.json: no such file"));
}

std::string refused(const Selection& selection) {
    Comparison c = comparison_of(kWholeComparison);
    try {
        apply(selection, c);
    } catch (const UsageError& error) {
        return error.what();
    }
    return {};
}

TEST(Selection, ChoosesVariantsDataSeedsAndMetrics) {
    Comparison c = comparison_of(kWholeComparison);
    Selection selection;
    selection.only = {"c", "real"};
    selection.seeds = "7..8";
    selection.metrics = {"x:lower:0.25", "y"};
    selection.last = {PipelineChange::of_set("s.p=1")};
    apply(selection, c);
    ASSERT_EQ(c.variants.size(), 2U);
    EXPECT_EQ(c.variants[c.reference].name, "b") << "the reference stays";
    EXPECT_EQ(c.variants[1].changes.back().set, "s.p=1");
    ASSERT_EQ(c.data.size(), 1U);
    EXPECT_THAT(c.seeds_of(c.data[0]), ElementsAre(7, 8));
    ASSERT_EQ(c.metrics.size(), 2U);
    EXPECT_EQ(c.metrics[0].margin, 0.25);
    EXPECT_EQ(c.metrics[1].better, Direction::none);

    Selection folders;
    folders.folders = {"a/one/", "b/one", "two"};
    apply(folders, c);
    ASSERT_EQ(c.data.size(), 3U);
    EXPECT_EQ(c.data[0].name, "one");
    EXPECT_EQ(c.data[1].name, "b/one");
    EXPECT_EQ(c.data[2].name, "two");
}

TEST(Selection, RefusesWrongWords) {
    EXPECT_THAT(refused({{"reall"}, {}, "", {}, {}}), HasSubstr("did you mean 'real'?"));
    EXPECT_THAT(refused({{}, {"x", "x"}, "", {}, {}}), HasSubstr("is given twice"));
    EXPECT_THAT(refused({{}, {}, "x", {}, {}}), HasSubstr("--seeds 'x' is no seed range"));
    EXPECT_THAT(refused({{}, {}, "", {"m", "m:lower"}, {}}), HasSubstr("is given twice"));
    for (const char* metric : {"", ":lower", "m:small", "m:lower:x", "m:lower:-1"})
        EXPECT_THAT(refused({{}, {}, "", {metric}, {}}), HasSubstr("expected NAME")) << metric;
}

TEST(Selection, TheQuickFormComparesWithTheFirst) {
    const Comparison c = quick_comparison({"x/a.json", "b.json", "y/a.json"});
    EXPECT_EQ(c.name, "a-b-a");
    ASSERT_EQ(c.variants.size(), 3U);
    EXPECT_EQ(c.variants[0].name, "a");
    EXPECT_EQ(c.variants[2].name, "y/a.json");
    EXPECT_THAT(c.metrics, IsEmpty());
    EXPECT_THROW(quick_comparison({"a.json", "a.json", "a.json"}), UsageError);
}

}  // namespace
}  // namespace petal::compare
