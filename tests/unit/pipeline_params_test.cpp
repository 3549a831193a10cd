// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <stdexcept>
#include <utility>

#include "pipeline_fakes.hpp"

// Mistakes in parameters with their exact messages: users and editors read them.

namespace petal::pipeline_fakes {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

TEST(PipelineParams, parameters) {
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

TEST(PipelineParams, a_lower_bound_alone_is_told_as_such) {
    EXPECT_THAT(
        problems({pipeline({kScene, kFilter}), {}, {"clean.min_neighbours=0"}}),
        ElementsAre("--set: stages.clean.params.min_neighbours: 0 is out of range; expected "
                    "an integer, at least 1"));
    EXPECT_THAT(
        problems({pipeline({kScene, kFilter}), {}, {"clean.min_neighbours=3000000000"}}),
        ElementsAre("--set: stages.clean.params.min_neighbours: 3000000000 is out of range; "
                    "expected an integer, 1 to 2147483647"));
}

TEST(PipelineParams, relations_between_parameters_stand_where_the_last_value_came_from) {
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

TEST(PipelineParams, data_is_asked_for_once) {
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

TEST(PipelineParams, expansions) {
    const std::string p = "p.json:2: stages.k.params.";
    const std::string known = " is unknown; expected one of data, out, env:NAME";
    const std::vector<std::pair<std::string, std::string>> cases{
        {R"("text": "${foo}")", p + "text: '${foo}'" + known},
        {R"("text": "${}")", p + "text: '${}'" + known},
        {R"("text": "${DATA}")", p + "text: '${DATA}'" + known},
        {R"("text": "${ data}")", p + "text: '${ data}'" + known + "; did you mean 'data'?"},
        {R"("text": "${a${data}}")", p + "text: '${a${data}'" + known},
        {R"("path": "${data}/${foo}")", p + "path: '${foo}'" + known},
        {R"("text": "${env:}")", p + "text: '${env:}' names no environment variable; expected "
                                     "letters, digits and '_' after 'env:'"},
        {R"("paths": ["a", "${"])", p + "paths[1]: '${' has no end; expected '}'"},
        {R"("mode": "${data}")", p + "mode: unknown choice '${data}'; expected one of slow, fast"},
    };
    for (const auto& [param, expected] : cases)
        EXPECT_THAT(problems({pipeline({"\"k\": {\"type\": \"source.kinds\", \"params\": {" +
                                        param + "}}"}),
                              {},
                              {}}),
                    ElementsAre(expected))
            << param;
}

TEST(PipelineParams, numbers_too_large_for_anything) {
    const auto with = [](const std::string& param) {
        return problems(
            {pipeline({"\"k\": {\"type\": \"source.kinds\", \"params\": {" + param + "}}"}),
             {},
             {}});
    };
    const std::string p = "p.json:2: stages.k.params.";
    EXPECT_THAT(with(R"("length": 1e309)"),
                ElementsAre(p + "length: 1e309 does not fit a double; expected a number up to "
                                "1e308"));
    EXPECT_THAT(with(R"("length": 1e-400)"),
                ElementsAre(p + "length: 1e-400 does not fit a double; expected a number of "
                                "1e-307 to 1e308 in size, or 0"));
    EXPECT_THAT(with(R"("lengths": [1, )" + std::string(400, '9') + "]"),
                ElementsAre(p + "lengths[1]: " + std::string(80, '9') +
                            "... does not fit a double; expected a number up to 1e308"));
    EXPECT_THAT(with(R"("counts": [-9223372036854775809])"),
                ElementsAre(p + "counts[0]: -9223372036854775809 does not fit 64 bits; expected "
                                "a smaller number"));
    EXPECT_THAT(with(R"("count": 1e3)"),
                ElementsAre(p + "count: 1e3 is no integer; expected an integer"));
}

TEST(PipelineParams, a_relation_that_throws_names_the_plugin) {
    Registry registry;
    StageSpec spec = describe_stage<Scene>("source.scene");
    spec.check_params = nullptr;
    registry.add(spec);
    spec = describe_stage<Kinds>("source.kinds");
    spec.plugin = "toys";
    spec.check_params = [](const void* params) {
        if (static_cast<const KindsParams*>(params)->flag) throw std::logic_error("out of order");
        return std::vector<std::string>{};
    };
    registry.add(spec);
    PipelineRequest request;
    request.file = "p.json";
    const CheckedPipeline checked = read_pipeline_texts(
        {"p.json", pipeline({R"("k": {"type": "source.kinds", "params": {"flag": true}})"})}, {},
        request, registry);
    ASSERT_EQ(checked.problems.size(), 1U);
    EXPECT_EQ(to_string(checked.problems[0]),
              "p.json:2: stages.k.params: the check of source.kinds (plugin toys) failed: out of "
              "order");
}

}  // namespace
}  // namespace petal::pipeline_fakes
