// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <utility>

#include "pipeline_fakes.hpp"

// Mistakes of the graph (wires, cycles, rates) with their exact messages: users and editors read
// them.

namespace petal::pipeline_fakes {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

TEST(GraphProblems, wires) {
    const std::string p = "p.json:3: stages.b.in.";
    const std::vector<std::pair<std::string, std::string>> cases{
        {R"("detector.boards")", p + "cloud: required input 'cloud' (Cloud) is not wired; expected "
                                     "a wire of type Cloud, as "
                                     "scene.cloud"},
        {R"("detector.boards", "in": {"images": "scene.images"})",
         p + "cloud: required input 'cloud' (Cloud) is not wired; expected a wire of type Cloud, "
             "as "
             "scene.cloud"},
        {R"("detector.boards", "in": {"foo": "scene.cloud"})",
         p + "foo: unknown input 'foo' of detector.boards; expected one of cloud, images"},
        {R"("detector.boards", "in": {"cloud": "scene"})",
         p + "cloud: 'scene' is no wire; expected \"STAGE.PORT\"; did you mean 'scene.cloud'?"},
        {R"("detector.boards", "in": {"cloud": "scene.cloud.x"})",
         p + "cloud: 'scene.cloud.x' is no wire; expected \"STAGE.PORT\""},
        {R"("detector.boards", "in": {"cloud": ""})",
         p + "cloud: '' is no wire; expected \"STAGE.PORT\""},
        {R"("detector.boards", "in": {"cloud": "scene.clouds"})",
         p + "cloud: unknown output 'clouds' of 'scene' (source.scene); expected one of cloud, "
             "images; did you mean 'cloud'?"},
        {R"("detector.boards", "in": {"cloud": "scene.images"})",
         p + "cloud: two types on one wire: 'scene.images' writes Images, 'cloud' reads Cloud; "
             "expected a wire of type Cloud, as scene.cloud"},
        {R"("detector.boards", "in": {"cloud": ["scene.cloud"]})",
         p + "cloud: input 'cloud' takes one wire, not a list (it gathers nothing); expected "
             "\"STAGE.PORT\""},
        {R"("solver.mean", "in": {"poses": []})",
         p + "poses: the list has no wire; expected [\"STAGE.PORT\", ...]"},
        {R"("solver.mean", "in": {"poses": ["scene.cloud"]})",
         p + "poses[0]: two types on one wire: 'scene.cloud' writes Cloud, 'poses' reads Pose; "
             "expected a wire of type Pose, as b.pose"},
        {R"("source.kinds", "in": {"cloud": "scene.cloud"})",
         p + "cloud: unknown input 'cloud' of source.kinds; expected none"},
        {R"("sink.overlay")",
         p + "pose: required input 'pose' (Pose) is not wired; expected a stage that writes Pose"},
    };
    for (const auto& [stage, expected] : cases)
        EXPECT_THAT(problems({pipeline({kScene, "\"b\": {\"type\": " + stage + "}"}), {}, {}}),
                    ElementsAre(expected))
            << stage;
    EXPECT_THAT(
        problems(
            {pipeline({kScene,
                       R"("b": {"type": "detector.boards", "in": {"cloud": "scene.cloud"}})",
                       R"("m": {"type": "solver.mean", "in": {"poses": ["b.pose", "b.pose"]}})"}),
             {},
             {}}),
        ElementsAre(
            "p.json:4: stages.m.in.poses[1]: 'b.pose' is wired to 'poses' already; expected "
            "each wire once"));
    EXPECT_THAT(
        problems({pipeline({kScene, R"("v": {"type": "sink.viewer"})"}), {}, {}}),
        ElementsAre("p.json:3: stages.v.in: no input of 'v' is wired, so it would never fire; "
                    "expected one of cloud, images"));
    EXPECT_THAT(
        problems({pipeline({kScene, R"("v": {"type": "sink.viewer"})"}),
                  {R"({"stages": {"scene": null}})"},
                  {}}),
        ElementsAre("p.json:3: stages.v.in: no input of 'v' is wired, so it would never fire; "
                    "expected one of cloud, images"));
}

TEST(GraphProblems, one_mistake_is_one_problem) {
    // An unknown type: neither wires to and from it nor its parameters, nor the absence of a
    // source.
    EXPECT_THAT(
        problems({pipeline({R"("s": {"type": "x.y", "params": {"a": 1}})",
                            R"("f": {"type": "filter.radius", "in": {"cloud": "s.cloud"}})"}),
                  {},
                  {}})
            .size(),
        1U);
    // A stage that is no object: no further "no stage" for the wires from it.
    EXPECT_THAT(problems({pipeline({R"("scene": 5)", kFilter}), {}, {}}).size(), 1U);
    // A broken wire: no rate problem behind it.
    EXPECT_THAT(
        problems({pipeline({kScene, R"("b": {"type": "detector.boards", "in": {"cloud": "x.y"}})",
                            R"("o": {"type": "sink.overlay",
                                       "in": {"pose": "b.pose", "cloud": "scene.cloud"}})"}),
                  {},
                  {}})
            .size(),
        1U);
}

TEST(GraphProblems, cycles_are_told_once_with_their_path) {
    const auto filter = [](const std::string& id, const std::string& from) {
        return "\"" + id + "\": {\"type\": \"filter.radius\", \"in\": {\"cloud\": \"" + from +
               ".cloud\"}}";
    };
    const std::string expected = "; expected wires that lead from sources to sinks only";
    EXPECT_THAT(problems({pipeline({kScene, filter("a", "c"), filter("b", "a"), filter("c", "b"),
                                    filter("d", "c"), filter("x", "y"), filter("y", "x"),
                                    filter("z", "z")}),
                          {},
                          {}}),
                ElementsAre("p.json:3: stages.a.in.cloud: cycle: a -> b -> c -> a" + expected,
                            "p.json:7: stages.x.in.cloud: cycle: x -> y -> x" + expected,
                            "p.json:9: stages.z.in.cloud: cycle: z -> z" + expected));
    // A long chain needs no stack.
    std::vector<std::string> chain{kScene, filter("s0", "scene")};
    for (int i = 1; i < 3000; ++i)
        chain.push_back(filter("s" + std::to_string(i), "s" + std::to_string(i - 1)));
    EXPECT_THAT(problems({pipeline(chain), {}, {}}), IsEmpty());
}

TEST(GraphProblems, a_gathering_cycle_is_a_cycle) {
    EXPECT_THAT(
        problems({pipeline({kScene, R"("m": {"type": "solver.mean", "in": {"poses": ["n.pose"]}})",
                            R"("n": {"type": "solver.mean", "in": {"poses": "m.pose",
                                    "prior": "m.pose"}})"}),
                  {},
                  {}}),
        ElementsAre("p.json:3: stages.m.in.poses[0]: cycle: m -> n -> m; expected wires that "
                    "lead from sources to sinks only"));
}

TEST(GraphProblems, rates) {
    const std::string boards =
        R"("b": {"type": "detector.boards", "in": {"cloud": "scene.cloud"}})";
    const std::string mean = R"("m": {"type": "solver.mean", "in": {"poses": "b.pose"}})";
    EXPECT_THAT(
        problems({pipeline({kScene, boards, mean, R"("o": {"type": "sink.overlay",
                            "in": {"pose": "m.pose",
                                   "cloud": "scene.cloud"}})"}),
                  {},
                  {}}),
        ElementsAre("p.json:6: stages.o.in.pose: two rates: 'm.pose' fires once, after the last "
                    "frame, but 'scene.cloud' (stages.o.in.cloud) brings a packet for each frame; "
                    "expected one rate on the inputs of 'o'"));
    EXPECT_THAT(
        problems({pipeline({kScene, boards, R"("m": {"type": "solver.mean",
                            "in": {"poses": "b.pose", "prior": "b.pose"}})"}),
                  {},
                  {}}),
        ElementsAre("p.json:5: stages.m.in.prior: two rates: 'm' gathers and fires once, after the "
                    "last frame, but 'b.pose' brings a packet for each frame; expected a once wire "
                    "on 'prior'"));
    // A gathering port takes both rates; a once wire may feed a plain one.
    EXPECT_THAT(problems({pipeline({kScene, boards, mean, R"("n": {"type": "solver.mean",
                            "in": {"poses": ["b.pose", "m.pose"], "prior": "m.pose"}})"}),
                          {},
                          {}}),
                IsEmpty());
}

}  // namespace
}  // namespace petal::pipeline_fakes
