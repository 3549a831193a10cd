// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "pipeline.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <limits>

#include "pipeline_fakes.hpp"

namespace petal::pipeline_fakes {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

std::vector<std::string> ids(const Pipeline& pipeline) {
    std::vector<std::string> names;
    for (const StageNode& stage : pipeline.stages) names.push_back(stage.id);
    return names;
}

const std::string kWhole = pipeline(
    {R"("result": {"type": "sink.overlay", "in": {"pose": "mean.pose"}})",
     R"("mean": {"type": "solver.mean", "in": {"poses": ["b.pose", "a.pose"]}})",
     R"("b": {"type": "detector.boards", "in": {"cloud": "scene.cloud", "images": "scene.images"}})",
     R"("a": {"type": "detector.boards", "about": "A.", "in": {"cloud": "clean.cloud"}})",
     R"("clean": {"type": "filter.radius", "in": {"cloud": "scene.cloud"}, "params": {"radius": 0.1}})",
     kScene});

TEST(Pipeline, is_read_with_defaults_order_and_rates) {
    const CheckedPipeline checked = read({kWhole, {}, {}});
    ASSERT_TRUE(checked.pipeline);
    const Pipeline& p = *checked.pipeline;
    EXPECT_EQ(p.name, "p");
    EXPECT_EQ(p.seed, 0U);
    EXPECT_THAT(ids(p), ElementsAre("scene", "b", "clean", "a", "mean", "result"));
    EXPECT_FALSE(p.find("scene")->once);
    EXPECT_FALSE(p.find("a")->once);
    EXPECT_TRUE(p.find("mean")->once);
    EXPECT_TRUE(p.find("result")->once);
    EXPECT_EQ(p.find("nobody"), nullptr);
    // Gathered wires keep the order of the pipeline.
    const auto& poses = p.find("mean")->inputs.at("poses");
    ASSERT_EQ(poses.size(), 2U);
    EXPECT_EQ(poses[0].stage + "." + poses[0].port, "b.pose");
    EXPECT_EQ(poses[1].stage, "a");
    const StageNode& clean = *p.find("clean");
    EXPECT_EQ(clean.spec->type, "filter.radius");
    EXPECT_EQ(std::get<double>(clean.values.at("radius")), 0.1);
    EXPECT_EQ(std::get<std::int64_t>(clean.values.at("min_neighbours")), 6);
    const auto* params = static_cast<const RadiusParams*>(clean.params.get());
    EXPECT_EQ(params->radius, 0.1);
    EXPECT_EQ(params->loss, "huber");
}

TEST(Pipeline, every_kind_of_value_reaches_the_params) {
    const CheckedPipeline checked = read({pipeline({R"("k": {"type": "source.kinds", "params": {
        "flag": true, "count": -2147483648, "big": 9223372036854775807, "length": 1, "text": "t",
        "mode": "fast", "path": "c d", "flags": [false], "counts": [9, 0], "lengths": [0, 0.5],
        "texts": [], "modes": ["slow", "fast"], "paths": ["x", "y"]}})"}),
                                          {},
                                          {}});
    ASSERT_TRUE(checked.pipeline) << to_string(checked.problems.at(0));
    const auto& k = *static_cast<const KindsParams*>(checked.pipeline->stages[0].params.get());
    EXPECT_TRUE(k.flag);
    EXPECT_EQ(k.count, std::numeric_limits<int>::min());
    EXPECT_EQ(k.big, std::numeric_limits<std::int64_t>::max());
    EXPECT_EQ(k.length, 1.0);
    EXPECT_EQ(k.text, "t");
    EXPECT_EQ(k.mode, "fast");
    EXPECT_EQ(k.path, "c d");
    EXPECT_THAT(k.flags, ElementsAre(false));
    EXPECT_THAT(k.counts, ElementsAre(9, 0));
    EXPECT_THAT(k.lengths, ElementsAre(0.0, 0.5));
    EXPECT_THAT(k.texts, IsEmpty());
    EXPECT_THAT(k.modes, ElementsAre("slow", "fast"));
    EXPECT_THAT(k.paths, ElementsAre("x", "y"));
}

TEST(Pipeline, patches_and_sets_apply_in_order) {
    const std::string variant = R"({"petal": 1, "about": "variant", "seed": 5, "stages": {
        "clean": {"params": {"radius": 0.2, "min_neighbours": 3}}, "b": null,
        "mean": {"in": {"poses": "a.pose"}}}})";
    const CheckedPipeline checked =
        read({kWhole,
              {variant, R"({"stages": {"clean": {"params": {"radius": 0.25}}}})"},
              {"clean.min_neighbours=4", "clean.loss=\"none\"", "scene.files=[\"a\",\"b\"]"}});
    ASSERT_TRUE(checked.pipeline) << to_string(checked.problems.at(0));
    EXPECT_EQ(checked.pipeline->about, "variant");
    EXPECT_EQ(checked.pipeline->seed, 5U);
    EXPECT_EQ(checked.pipeline->find("b"), nullptr);
    const auto& values = checked.pipeline->find("clean")->values;
    EXPECT_EQ(std::get<double>(values.at("radius")), 0.25);
    EXPECT_EQ(std::get<std::int64_t>(values.at("min_neighbours")), 4);
    EXPECT_EQ(std::get<std::string>(values.at("loss")), "none");
    EXPECT_THAT(
        std::get<std::vector<std::string>>(checked.pipeline->find("scene")->values.at("files")),
        ElementsAre("a", "b"));
}

TEST(Pipeline, a_stage_is_swapped_by_type_alone) {
    const CheckedPipeline checked =
        read({pipeline({kScene, R"("f": {"type": "filter.radius", "in": {"cloud": "scene.cloud"},
                                         "params": {"radius": 0.1}})"}),
              {R"({"stages": {"f": {"type": "detector.boards"}}})"},
              {}});
    ASSERT_TRUE(checked.pipeline) << to_string(checked.problems.at(0));
    EXPECT_EQ(checked.pipeline->find("f")->spec->type, "detector.boards");
}

TEST(Pipeline, the_seed_of_the_request_goes_before_that_of_the_file) {
    const std::string text =
        R"({"petal": 1, "seed": 18446744073709551615, "stages": {)" + kScene + "}}";
    EXPECT_EQ(read({text, {}, {}}).pipeline->seed, std::numeric_limits<std::uint64_t>::max());
    PipelineRequest request;
    request.seed = 9;
    EXPECT_EQ(read({text, {}, {}}, request).pipeline->seed, 9U);
}

TEST(Pipeline, expands_data_out_and_environment_in_params_and_defaults) {
    ::setenv("PETAL_TEST_NAME", "${data}", 1);  // what it brings is not expanded again
    PipelineRequest request;
    request.data = "/d";
    request.out = "/o";
    const Input input{
        pipeline({kScene, R"("k": {"type": "source.kinds", "params": {"text": "$5 ${out}/${data}",
                            "paths": ["${data}/a", "${env:PETAL_TEST_NAME}"]}})"}),
        {},
        {}};
    const CheckedPipeline checked = read(input, request);
    ASSERT_TRUE(checked.pipeline) << to_string(checked.problems.at(0));
    const auto& k = *static_cast<const KindsParams*>(checked.pipeline->find("k")->params.get());
    EXPECT_EQ(k.text, "$5 /o//d");
    EXPECT_THAT(k.paths, ElementsAre("/d/a", "${data}"));
    const auto& s = *static_cast<const SceneParams*>(checked.pipeline->find("scene")->params.get());
    EXPECT_THAT(s.files, ElementsAre("/d/scene.rawlog"));
    // Without a data folder the check leaves it as it is.
    const CheckedPipeline without = read(input);
    ASSERT_TRUE(without.pipeline);
    EXPECT_EQ(static_cast<const KindsParams*>(without.pipeline->find("k")->params.get())->text,
              "$5 ${out}/${data}");
    // The effective pipeline is the same for both.
    EXPECT_EQ(without.pipeline->effective_json, checked.pipeline->effective_json);
}

TEST(Pipeline, effective_json_is_exact) {
    const CheckedPipeline checked =
        read({pipeline({kFilter, kScene}), {R"({"about": "x"})"}, {"clean.radius=0.1"}});
    EXPECT_EQ(checked.pipeline->effective_json, R"({
  "petal": 1,
  "about": "x",
  "seed": 0,
  "stages": {
    "scene": {
      "type": "source.scene",
      "params": {
        "files": [
          "${data}/scene.rawlog"
        ]
      }
    },
    "clean": {
      "type": "filter.radius",
      "in": {
        "cloud": "scene.cloud"
      },
      "params": {
        "radius": 0.1,
        "outer_radius": 0.5,
        "min_neighbours": 6,
        "loss": "huber"
      }
    }
  }
}
)");
}

TEST(Pipeline, effective_json_reads_back_and_gives_the_same) {
    const std::string kinds = pipeline(
        {R"("k": {"type": "source.kinds", "params": {"length": 0.30000000000000004, "big": -7,
         "lengths": [1, 4.9e-324], "text": "\"\\\u0001é ${data}", "modes": []}})"});
    for (const std::string& text : {kWhole, kinds}) {
        const CheckedPipeline first = read({text, {R"({"seed": 18446744073709551615})"}, {}});
        ASSERT_TRUE(first.pipeline) << to_string(first.problems.at(0));
        const CheckedPipeline second = read({first.pipeline->effective_json, {}, {}});
        ASSERT_TRUE(second.pipeline) << to_string(second.problems.at(0));
        EXPECT_EQ(second.pipeline->effective_json, first.pipeline->effective_json);
        EXPECT_EQ(second.pipeline->seed, first.pipeline->seed);
        EXPECT_EQ(ids(*second.pipeline), ids(*first.pipeline));
        for (const StageNode& stage : first.pipeline->stages) {
            const StageNode& again = *second.pipeline->find(stage.id);
            EXPECT_EQ(again.values, stage.values) << stage.id;
            EXPECT_EQ(again.once, stage.once);
            for (const auto& [port, wires] : stage.inputs) {
                ASSERT_EQ(again.inputs.at(port).size(), wires.size());
                for (std::size_t i = 0; i < wires.size(); ++i)
                    EXPECT_EQ(again.inputs.at(port)[i].stage, wires[i].stage);
            }
        }
    }
}

TEST(Pipeline, dot_shows_types_and_rates) {
    const CheckedPipeline checked = read(
        {pipeline({kScene, R"("b": {"type": "detector.boards", "in": {"cloud": "scene.cloud"}})",
                   R"("m": {"type": "solver.mean", "in": {"poses": "b.pose"}})",
                   R"("o": {"type": "sink.overlay", "in": {"pose": "m.pose"}})"}),
         {},
         {}});
    ASSERT_TRUE(checked.pipeline);
    EXPECT_EQ(to_dot(*checked.pipeline), R"(digraph "p" {
  rankdir=LR;
  node [shape=box, fontname="sans-serif"];
  edge [fontname="sans-serif", fontsize=10];
  "scene" [label="scene\nsource.scene"];
  "b" [label="b\ndetector.boards"];
  "m" [label="m\nsolver.mean", peripheries=2];
  "o" [label="o\nsink.overlay", peripheries=2];
  "scene" -> "b" [label="Cloud"];
  "b" -> "m" [label="Pose"];
  "m" -> "o" [label="Pose", style=bold];
}
)");
}

}  // namespace
}  // namespace petal::pipeline_fakes
