// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <utility>

#include "pipeline_fakes.hpp"

// Mistakes in patches and --set options with their exact messages, each at its own place.

namespace petal::pipeline_fakes {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

TEST(PipelinePatches, sets) {
    const std::string usage =
        "' sets nothing; expected STAGE.PARAM=JSON, as in solve.iterations=50";
    const std::string p = "--set: stages.clean.params.";
    const std::vector<std::pair<std::string, std::string>> cases{
        {"clean.loss=cauchy", p + "loss: 'cauchy' is no JSON; a string needs its own quotes: --set "
                                  "'clean.loss=\"cauchy\"'"},
        // Found by fuzzing: what is repeated to the user is made printable.
        {"c\nn.l\x1b=cauchy",
         "--set: stages[\"c\\x0an\"].params[\"l\\x1b\"]: 'cauchy' is no JSON; a string needs its "
         "own quotes: --set 'c\\x0an.l\\x1b=\"cauchy\"'"},
        {"clean.loss=", p + "loss: has no value; expected STAGE.PARAM=JSON"},
        {"clean.radius=0.2m",
         p + "radius: syntax error while parsing value - invalid literal; last "
             "read: '0.2m'; expected end of input"},
        {"clean.radius=\"0.2\"",
         p + "radius: the string '0.2' is no number; expected a number, 0.001 to 10 m"},
        {"clean.radis=0.2",
         p + "radis: unknown parameter 'radis' of filter.radius; expected one of radius, "
             "outer_radius, min_neighbours, loss; did you mean 'radius'?"},
        {"clean.radius=null",
         p + "radius: null removes 'radius', which is not there; expected nothing to remove"},
        {"claen.radius=1",
         "--set: stages.claen: no stage 'claen' to change; expected a type for a new stage, or an "
         "id "
         "of the pipeline; did you mean 'clean'?"},
        {"radius=0.2", "--set: 'radius=0.2" + usage},
        {"clean.radius", "--set: 'clean.radius" + usage},
        {"clean.params.radius=1", "--set: 'clean.params.radius=1" + usage},
        {"=1", "--set: '=1" + usage},
        {"clean.=1", "--set: 'clean.=1" + usage},
        {".radius=1", "--set: '.radius=1" + usage},
    };
    for (const auto& [option, expected] : cases)
        EXPECT_THAT(problems({pipeline({kScene, kFilter}), {}, {option}}), ElementsAre(expected))
            << option;
    EXPECT_THAT(problems({pipeline({kScene, kFilter}), {}, {"scene.files=[\"a=b.c\"]"}}),
                IsEmpty());
}

TEST(PipelinePatches, patches_are_named_with_their_own_lines) {
    EXPECT_THAT(
        problems({pipeline({kScene, kFilter}),
                  {"{\"petal\": 2,\n\"stages\": {\"clean\": {\n\"params\": {\"radius\": 99}}}}",
                   "{\"stagse\": {}}", "[]"},
                  {}}),
        ElementsAre(
            "v1.json:1: petal: unknown format version: 2; expected \"petal\": 1, the format "
            "that this program reads",
            "v2.json:1: stagse: unknown key 'stagse' in a patch; expected one of petal, "
            "$schema, about, seed, stages; did you mean 'stages'?",
            "v3.json:1: a list is no patch; expected an object, { ... }"));
    EXPECT_THAT(
        problems({pipeline({kScene, kFilter}),
                  {"{\"stages\": {\"clean\": {\n\"params\": {\"radius\": 99}},\n\"scene\": "
                   "{\"type\": null},\n"
                   "\"new\": {\"in\": {}}}}"},
                  {}}),
        ElementsAre("v1.json:2: stages.clean.params.radius: 99 is out of range; expected a number, "
                    "0.001 to 10 m",
                    "v1.json:3: stages.scene.type: null is no string; expected the stage's type, "
                    "KIND.NAME",
                    "v1.json:4: stages.new: no stage 'new' to change; expected a type for a new "
                    "stage, or an id of the pipeline"));
}

TEST(PipelinePatches, what_a_patch_took_away_names_the_patch) {
    EXPECT_THAT(
        problems({pipeline({kScene, kFilter}),
                  {"{\"stages\": {\"clean\": {\n\"in\": {\"cloud\":\nnull}}}}"},
                  {}}),
        ElementsAre("v1.json:2: stages.clean.in.cloud: required input 'cloud' (Cloud) is not "
                    "wired; expected a wire of type Cloud, as clean.cloud or scene.cloud"));
    EXPECT_THAT(problems({pipeline({kScene, R"("other": {"type": "source.scene"})", kFilter}),
                          {"{\"stages\": {\n\"scene\": null}}"},
                          {}}),
                ElementsAre("p.json:4: stages.clean.in.cloud: no stage 'scene' (removed in "
                            "v1.json:2); expected one of clean, other"));
}

TEST(PipelinePatches, that_are_no_json) {
    const std::string base = pipeline({kScene, kFilter});
    EXPECT_THAT(problems({base, {"", "{\n\"seed\": 1,\n}", "\"\xff\""}, {}}),
                ElementsAre("v1.json:1: is empty; expected JSON",
                            "v2.json:3: syntax error while parsing object key - unexpected '}'; "
                            "expected string literal",
                            "v3.json:1: syntax error while parsing value - invalid string: "
                            "ill-formed UTF-8 byte; last read: '\"?'"));
    EXPECT_THAT(problems({base,
                          {"{\"stages\": {\"clean\": {\"params\": {\n\"radius\": 0.3,\n\"radius\": "
                           "0.4}}}}"},
                          {}}),
                ElementsAre("v1.json:3: stages.clean.params.radius: duplicate key 'radius'; it "
                            "stands in line 2 already; expected once"));
}

TEST(PipelinePatches, wires_of_a_patch_are_told_at_its_lines) {
    const std::string base = pipeline({kScene, kFilter});
    const auto patched = [&](const std::string& stages) {
        return problems({base, {"{\"stages\": {\n" + stages + "}}"}, {}});
    };
    EXPECT_THAT(patched(R"("clean": {"in": {"cloud": "scene.images"}})"),
                ElementsAre("v1.json:2: stages.clean.in.cloud: two types on one wire: "
                            "'scene.images' writes Images, 'cloud' reads Cloud; expected a wire "
                            "of type Cloud, as clean.cloud or scene.cloud"));
    EXPECT_THAT(patched(R"("clean": {"in": {"cloud": "clean.cloud"}})"),
                ElementsAre("v1.json:2: stages.clean.in.cloud: cycle: clean -> clean; expected "
                            "wires that lead from sources to sinks only"));
    EXPECT_THAT(patched(R"("clean": {"type": "filter.radios"})"),
                ElementsAre("v1.json:2: stages.clean.type: unknown stage type 'filter.radios'; "
                            "expected one that 'petal stages' lists; did you mean "
                            "'filter.radius'?"));
    EXPECT_THAT(patched(R"("clean": {"in": {"clod": "scene.cloud"}})"),
                ElementsAre("v1.json:2: stages.clean.in.clod: unknown input 'clod' of "
                            "filter.radius; expected cloud; did you mean 'cloud'?"));
}

TEST(PipelinePatches, sets_of_values_that_cannot_be) {
    const std::string p = "--set: stages.clean.params.radius";
    const std::vector<std::pair<std::string, std::string>> cases{
        {"clean.radius=1e400", p + ": 1e400 does not fit a double; expected a number up to 1e308"},
        {"clean.radius=99999999999999999999",
         p + ": 99999999999999999999 does not fit 64 bits; expected a smaller number"},
        {"clean.radius=[0.1]", p + ": a list is no number; expected a number, 0.001 to 10 m"},
        {"clean.radius={}", p + ": an object is no number; expected a number, 0.001 to 10 m"},
        {"clean.radius=\"\xff\"", p + ": syntax error while parsing value - invalid string: "
                                      "ill-formed UTF-8 byte; last read: '\"?'"},
        {"clean.radius={\"a\":1,\"a\":2}",
         p + ".a: duplicate key 'a'; it stands in line 1 already; expected once"},
        {"clean.radius=" + std::string(100, '['),
         p + "[0][0]: nested too deep; expected at most 64 lists and objects inside one another"},
    };
    for (const auto& [option, expected] : cases)
        EXPECT_THAT(problems({pipeline({kScene, kFilter}), {}, {option}}),
                    ::testing::Contains(expected))
            << option;
}

}  // namespace
}  // namespace petal::pipeline_fakes
