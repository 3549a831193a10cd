// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <utility>

#include "pipeline_fakes.hpp"

// Every kind of mistake but those of the graph with its exact message: users and editors read them.

namespace petal::pipeline_fakes {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

TEST(PipelineProblems, five_different_mistakes_are_five_problems) {
    EXPECT_THAT(
        problems({"{ \"petal\": 1,\n"
                  "  \"stages\": {\n"
                  "    \"scene\": { \"type\": \"source.scene\" },\n"
                  "    \"clean\": { \"type\": \"filter.radis\",\n"
                  "               \"in\": { \"cloud\": \"scene.cloud\" } },\n"
                  "    \"thin\":  { \"type\": \"filter.radius\",\n"
                  "               \"in\": { \"clod\": \"scene.cloud\" },\n"
                  "               \"params\": { \"radios\": 0.1,\n"
                  "                           \"min_neighbours\": 3.7 } },\n"
                  "    \"board\": { \"type\": \"detector.boards\",\n"
                  "               \"in\": { \"cloud\": \"clean.cloud\",\n"
                  "                       \"images\": \"scen.images\" } }\n"
                  "  } }\n",
                  {},
                  {}}),
        ElementsAre(
            "p.json:4: stages.clean.type: unknown stage type 'filter.radis'; expected one that "
            "'petal stages' lists; did you mean 'filter.radius'?",
            "p.json:7: stages.thin.in.clod: unknown input 'clod' of filter.radius; expected cloud; "
            "did you mean 'cloud'?",
            "p.json:8: stages.thin.params.radios: unknown parameter 'radios' of filter.radius; "
            "expected one of radius, outer_radius, min_neighbours, loss; did you mean 'radius'?",
            "p.json:9: stages.thin.params.min_neighbours: 3.7 is no integer; expected an integer, "
            "at "
            "least 1",
            "p.json:12: stages.board.in.images: no stage 'scen'; expected one of board, clean, "
            "scene, thin; did you mean 'scene'?"));
}

TEST(PipelineProblems, only_unknown_types_are_marked_as_missing) {
    const CheckedPipeline checked = read({pipeline({R"("a": {"type": "source.rawlog"})",
                                                    R"("b": {"type": "source.scene", "x": 1})"}),
                                          {},
                                          {}});
    ASSERT_EQ(checked.problems.size(), 2U);
    EXPECT_TRUE(checked.problems[0].missing_type);
    EXPECT_FALSE(checked.problems[1].missing_type);
}

TEST(PipelineProblems, shape_of_the_document) {
    const std::string rest = ", \"stages\": {" + kScene + "}}";
    const std::vector<std::pair<std::string, std::string>> cases{
        {"[1]", "p.json:1: a list is no pipeline; expected an object, { ... }"},
        {"{\"petal\":\n2" + rest,
         "p.json:2: petal: unknown format version: 2; expected \"petal\": 1, the format that this "
         "program reads"},
        {"{\"petal\": 1.0" + rest,
         "p.json:1: petal: unknown format version: 1.0; expected \"petal\": 1, the format that "
         "this "
         "program reads"},
        {"{\"seed\": 1" + rest,
         "p.json:1: petal: missing; expected \"petal\": 1, the format that this program reads"},
        {"{\"petal\": 1, \"sed\": 1" + rest,
         "p.json:1: sed: unknown key 'sed' in a pipeline; expected one of petal, $schema, about, "
         "seed, stages; did you mean 'seed'?"},
        {"{\"petal\": 1, \"seed\": -1" + rest,
         "p.json:1: seed: -1 is no seed; expected an integer from 0"},
        {"{\"petal\": 1, \"seed\": 1.5" + rest,
         "p.json:1: seed: 1.5 is no seed; expected an integer from 0"},
        {"{\"petal\": 1, \"about\": 7" + rest, "p.json:1: about: 7 is no string; expected one"},
        {"{\"petal\": 1, \"$schema\": {}" + rest,
         "p.json:1: $schema: an object is no string; expected one"},
        {"{\"petal\": 1}", "p.json:1: stages: missing; expected an object of stages by their ids"},
        {"{\"petal\": 1, \"stages\": []}",
         "p.json:1: stages: a list is no object; expected the stages by their ids"},
        {"{\"petal\": 1, \"stages\":\n{}}",
         "p.json:2: stages: no stages; expected a source at least"},
    };
    for (const auto& [text, expected] : cases)
        EXPECT_THAT(problems({text, {}, {}}), ElementsAre(expected)) << text;
    EXPECT_THAT(problems({"{\"petal\": 1, \"$schema\": \"s\", \"about\": \"\"" + rest, {}, {}}),
                IsEmpty());
}

TEST(PipelineProblems, shape_of_a_stage) {
    const std::vector<std::pair<std::string, std::string>> cases{
        {R"("s": null)",
         "p.json:3: stages.s: null is no object; expected a stage with type, in, params"},
        {R"("s": {})", "p.json:3: stages.s.type: missing; expected the stage's type, KIND.NAME"},
        {R"("s": {"type": 1})",
         "p.json:3: stages.s.type: 1 is no string; expected the stage's type, KIND.NAME"},
        {R"("s": {"type": "source.scene", "parms": {}})",
         "p.json:3: stages.s.parms: unknown key 'parms' in a stage; expected one of type, about, "
         "in, "
         "params; did you mean 'params'?"},
        {R"("s": {"type": "source.scene", "about": true})",
         "p.json:3: stages.s.about: true is no string; expected one"},
        {R"("s": {"type": "source.scene", "params": []})",
         "p.json:3: stages.s.params: a list is no object; expected the parameters by their names"},
        {R"("s": {"type": "filter.radius", "in": "scene.cloud"})",
         "p.json:3: stages.s.in: the string 'scene.cloud' is no object; expected \"PORT\": "
         "\"STAGE.PORT\" for each input"},
        {R"("s": {"type": "filter.radius", "in": {"cloud": 3}})",
         "p.json:3: stages.s.in.cloud: 3 is no wire; expected \"STAGE.PORT\""},
        {R"("S-1": {"type": "source.scene"})",
         "p.json:3: stages.S-1: 'S-1' is no stage id; expected lower case letters, digits and '_', "
         "beginning with a letter"},
        {R"("1a": {"type": "source.scene"})",
         "p.json:3: stages.1a: '1a' is no stage id; expected lower case letters, digits and '_', "
         "beginning with a letter"},
        {R"("": {"type": "source.scene"})",
         "p.json:3: stages[\"\"]: '' is no stage id; expected lower case letters, digits and '_', "
         "beginning with a letter"},
        {R"("scene": {"type": "source.scene"})",
         "p.json:3: stages.scene: duplicate key 'scene'; it stands in line 2 already; expected "
         "once"},
    };
    for (const auto& [stage, expected] : cases)
        EXPECT_THAT(problems({pipeline({kScene, stage}), {}, {}}), ElementsAre(expected)) << stage;
}

TEST(PipelineProblems, parameters) {
    const std::string p = "p.json:2: stages.k.params.";
    const std::vector<std::pair<std::string, std::string>> cases{
        {R"("flag": 1)", p + "flag: 1 is no bool; expected true or false"},
        {R"("count": 3.0)", p + "count: 3.0 is no integer; expected an integer"},
        {R"("count": "3")", p + "count: the string '3' is no integer; expected an integer"},
        {R"("count": [3])", p + "count: a list is no integer; expected an integer"},
        {R"("count": null)", p + "count: null is no integer; expected an integer"},
        {R"("count": 2147483648)",
         p + "count: 2147483648 is out of range; expected an integer, -2147483648 to 2147483647"},
        {R"("big": 9223372036854775808)",
         p + "big: 9223372036854775808 does not fit 64 bits; expected a smaller number"},
        {R"("length": 1.5)", p + "length: 1.5 is out of range; expected a number, 0 to 1 m"},
        {R"("length": true)", p + "length: true is no number; expected a number, 0 to 1 m"},
        {R"("text": {})", p + "text: an object is no string; expected a string"},
        {R"("mode": "fst")",
         p + "mode: unknown choice 'fst'; expected one of slow, fast; did you mean 'fast'?"},
        {R"("mode": 1)", p + "mode: 1 is no choice; expected one of slow, fast"},
        {R"("path": 1)", p + "path: 1 is no path; expected a path (a string)"},
        {R"("path": "a\u0000b")",
         p + "path: a path cannot hold the character \\u0000; expected a path"},
        {R"("flags": [true, 0])", p + "flags[1]: 0 is no bool; expected true or false"},
        {R"("counts": 3)", p + "counts: 3 is no list; expected a list of integers, 0 to 9"},
        {R"("counts": [1, 10])", p + "counts[1]: 10 is out of range; expected an integer, 0 to 9"},
        {R"("counts": [1, 2.5])", p + "counts[1]: 2.5 is no integer; expected an integer, 0 to 9"},
        {R"("lengths": [[]])", p + "lengths[0]: a list is no number; expected a number, 0 to 1"},
        {R"("texts": "x")", p + "texts: the string 'x' is no list; expected a list of strings"},
        {R"("modes": ["slo"])",
         p + "modes[0]: unknown choice 'slo'; expected one of slow, fast; did you mean 'slow'?"},
        {R"("paths": "x")",
         p + "paths: the string 'x' is no list; expected a list of paths (strings)"},
        {R"("big": 99999999999999999999)",
         p + "big: 99999999999999999999 does not fit 64 bits; expected a smaller number"},
        {R"("text": "${dat}")", p + "text: '${dat}' is unknown; expected one of data, out, "
                                    "env:NAME; did you mean 'data'?"},
        {R"("text": "a${data")", p + "text: '${data' has no end; expected '}'"},
        {R"("text": "${env:9}")", p + "text: '${env:9}' names no environment variable; expected "
                                      "letters, digits and '_' after "
                                      "'env:'"},
        {R"("texts": ["x", "${env:PETAL_TEST_UNSET}"])",
         p + "texts[1]: the environment variable PETAL_TEST_UNSET is not set; expected a value for "
             "'${env:PETAL_TEST_UNSET}'"},
    };
    for (const auto& [param, expected] : cases)
        EXPECT_THAT(problems({pipeline({"\"k\": {\"type\": \"source.kinds\", \"params\": {" +
                                        param + "}}"}),
                              {},
                              {}}),
                    ElementsAre(expected))
            << param;
}

TEST(PipelineProblems, a_lower_bound_alone_is_told_as_such) {
    EXPECT_THAT(
        problems({pipeline({kScene, kFilter}), {}, {"clean.min_neighbours=0"}}),
        ElementsAre("--set: stages.clean.params.min_neighbours: 0 is out of range; expected "
                    "an integer, at least 1"));
    EXPECT_THAT(
        problems({pipeline({kScene, kFilter}), {}, {"clean.min_neighbours=3000000000"}}),
        ElementsAre("--set: stages.clean.params.min_neighbours: 3000000000 is out of range; "
                    "expected an integer, 1 to 2147483647"));
}

TEST(PipelineProblems, relations_between_parameters_stand_where_the_last_value_came_from) {
    const std::string message = "radius must be less than outer_radius";
    EXPECT_THAT(problems({pipeline({kScene, R"("clean": {"type": "filter.radius",
        "in": {"cloud": "scene.cloud"},
        "params": {"radius": 0.7}})"}),
                          {},
                          {}}),
                ElementsAre("p.json:5: stages.clean.params: " + message));
    EXPECT_THAT(problems({pipeline({kScene, kFilter}),
                          {"{\"stages\": {\"clean\": {\n\"params\": {\n\"radius\": 0.7}}}}"},
                          {}}),
                ElementsAre("v1.json:2: stages.clean.params: " + message));
    EXPECT_THAT(problems({pipeline({kScene, R"("clean": {"type": "filter.radius",
        "in": {"cloud": "scene.cloud"}, "params": {"radius": 0.4}})"}),
                          {},
                          {"clean.outer_radius=0.3"}}),
                ElementsAre("--set: stages.clean.params: " + message));
}

TEST(PipelineProblems, data_is_asked_for_once) {
    PipelineRequest request;
    request.need_data = true;
    const Input input{
        pipeline({kScene, R"("k": {"type": "source.kinds", "params": {"text": "${data}"}})"}),
        {},
        {}};
    EXPECT_THAT(
        problems(input, request),
        ElementsAre("p.json:2: stages.scene.params.files[0]: '${data}/scene.rawlog' needs the "
                    "data folder; expected --data DIR"));
    request.data = "d";
    EXPECT_THAT(problems(input, request), IsEmpty());
}

TEST(PipelineProblems, sets) {
    const std::string usage =
        "' sets nothing; expected STAGE.PARAM=JSON, as in solve.iterations=50";
    const std::string p = "--set: stages.clean.params.";
    const std::vector<std::pair<std::string, std::string>> cases{
        {"clean.loss=cauchy", p + "loss: 'cauchy' is no JSON; a string needs its own quotes: --set "
                                  "'clean.loss=\"cauchy\"'"},
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

TEST(PipelineProblems, patches_are_named_with_their_own_lines) {
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

TEST(PipelineProblems, what_a_patch_took_away_names_the_patch) {
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

TEST(PipelineProblems, are_sorted_by_input_and_line) {
    EXPECT_THAT(
        problems({pipeline({kScene, R"("clean": {"type": "filter.radius",
        "params": {"loss": 1, "min_neighbours": 2.5},
        "in": {"cloud": "nobody.cloud"}})"}),
                  {"{\"stages\": {\"clean\": {\"params\": {\"radius\": 0}}}}"},
                  {"clean.outer_radius=11", "clean.extra=1"}}),
        ElementsAre("p.json:4: stages.clean.params.min_neighbours: 2.5 is no integer; "
                    "expected an integer, at least 1",
                    "p.json:4: stages.clean.params.loss: 1 is no choice; expected one of "
                    "none, huber, cauchy",
                    "p.json:5: stages.clean.in.cloud: no stage 'nobody'; expected one of "
                    "clean, scene",
                    "v1.json:1: stages.clean.params.radius: 0 is out of range; expected a "
                    "number, 0.001 to 10 m",
                    "--set: stages.clean.params.outer_radius: 11 is out of range; expected a "
                    "number, 0.001 to 10 m",
                    "--set: stages.clean.params.extra: unknown parameter 'extra' of "
                    "filter.radius; expected one of radius, outer_radius, min_neighbours, "
                    "loss"));
}

TEST(PipelineProblems, hostile_text_is_made_printable) {
    const std::string name(5000, 'x');
    const auto found =
        problems({pipeline({kScene, "\"k\": {\"type\": \"source.kinds\", \"params\": {\"" + name +
                                        "\": 1, \"\\u001b[31m\": 2}}"}),
                  {},
                  {}});
    ASSERT_EQ(found.size(), 2U);
    for (const std::string& text : found) {
        EXPECT_LT(text.size(), 500U);
        EXPECT_EQ(text.find('\x1b'), std::string::npos);
    }
}

}  // namespace
}  // namespace petal::pipeline_fakes
