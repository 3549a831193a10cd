// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <utility>

#include "pipeline_fakes.hpp"

// Mistakes in the form of a pipeline, and how problems are told: exact messages, which users and
// editors read. Those of parameters, patches and the graph stand in files of their own.

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

// Found by fuzzing: ids that are none are listed among what was expected.
TEST(PipelineProblems, hostile_ids_are_made_printable) {
    const std::string escape = "\\u001b[31m";
    const auto found =
        problems({pipeline({"\"" + escape + "\": {\"type\": \"source.scene\"}",
                            "\"loop" + escape +
                                "\": {\"type\": \"filter.radius\", \"in\": {\"cloud\": "
                                "\"loop" +
                                escape + ".cloud\"}}",
                            R"("b": {"type": "detector.boards", "in": {"cloud": "nobody.cloud"}})",
                            "\"o\": {\"type\": \"sink.overlay\", \"in\": {\"pose\": \"" + escape +
                                ".cloud\"}}",
                            R"("m": {"type": "solver.mean"})"}),
                  {},
                  {}});
    EXPECT_GE(found.size(), 6U);
    for (const std::string& text : found) EXPECT_EQ(text.find('\x1b'), std::string::npos) << text;
    EXPECT_THAT(found, ::testing::Contains("p.json:4: stages.b.in.cloud: no stage 'nobody'; "
                                           "expected one of \\x1b[31m, b, loop\\x1b[31m, m, o"));
}

TEST(PipelineProblems, texts_that_are_no_pipeline) {
    const std::vector<std::pair<std::string, std::string>> cases{
        {"", "p.json:1: is empty; expected JSON"},
        {"\n \n", "p.json:1: is empty; expected JSON"},
        {"\xEF\xBB\xBF{}", "p.json:1: begins with a byte order mark; expected UTF-8 without one"},
        {"{\"petal\": 1, \"about\": \"\xe4\"}",
         "p.json:1: about: syntax error while parsing value - invalid string: ill-formed UTF-8 "
         "byte; last read: '\"?\"'"},
        {"{\"petal\":\n1,\n\"stages\": {",
         "p.json:3: stages: syntax error while parsing object key "
         "- unexpected end of input; expected string literal"},
        {std::string(70, '['),
         "p.json:1: [0][0]: nested too deep; expected at most 64 lists and objects inside one "
         "another"},
        {"null", "p.json:1: null is no pipeline; expected an object, { ... }"},
    };
    for (const auto& [text, expected] : cases)
        EXPECT_THAT(problems({text, {}, {}}), ElementsAre(expected)) << text;
}

TEST(PipelineProblems, versions_and_seeds_that_are_none) {
    const std::string rest = ", \"stages\": {" + kScene + "}}";
    const std::string version = "; expected \"petal\": 1, the format that this program reads";
    const std::vector<std::pair<std::string, std::string>> cases{
        {"{\"petal\": \"1\"", "p.json:1: petal: unknown format version: the string '1'" + version},
        {"{\"petal\": null", "p.json:1: petal: unknown format version: null" + version},
        {"{\"petal\": 18446744073709551615",
         "p.json:1: petal: unknown format version: 18446744073709551615" + version},
        {"{\"petal\": 99999999999999999999",
         "p.json:1: petal: 99999999999999999999 does not fit 64 bits; expected a smaller number"},
        {"{\"petal\": 1, \"seed\": 18446744073709551616",
         "p.json:1: seed: 18446744073709551616 does not fit 64 bits; expected a smaller number"},
        {"{\"petal\": 1, \"seed\": null",
         "p.json:1: seed: null is no seed; expected an integer from 0"},
        {"{\"petal\": 1, \"seed\": \"7\"",
         "p.json:1: seed: the string '7' is no seed; expected an integer from 0"},
        {"{\"petal\": 1,\n\"petal\": 1",
         "p.json:2: petal: duplicate key 'petal'; it stands in line 1 already; expected once"},
    };
    for (const auto& [text, expected] : cases)
        EXPECT_THAT(problems({text + rest, {}, {}}), ElementsAre(expected)) << text;
}

}  // namespace
}  // namespace petal::pipeline_fakes
