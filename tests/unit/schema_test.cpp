// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "schema.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <nlohmann/json.hpp>

#include "pipeline_fakes.hpp"

// What the schema says of each kind of declaration. That it says what `petal check` says, of
// petal's own stages and to an independent validator, is shown in tests/pipelines/schema_test.cpp.

namespace petal::pipeline_fakes {
namespace {

using nlohmann::json;

json pipeline_json() {
    return json::parse(pipeline_schema(registry()));
}
json definition(const json& schema, const std::string& type) {
    return schema["definitions"][type]["properties"];
}

TEST(Schema, of_parameters_has_kind_range_default_and_meaning) {
    const json params = definition(pipeline_json(), "source.kinds")["params"];
    EXPECT_EQ(params["additionalProperties"], false);
    const json& of = params["properties"];
    EXPECT_EQ(of.size(), 13U);
    EXPECT_EQ(of["flag"], json::parse(R"js({"type": "boolean", "default": false,
        "description": "bool (true or false)"})js"));
    EXPECT_EQ(of["count"], json::parse(R"js({"type": "integer", "minimum": -2147483648,
        "maximum": 2147483647, "default": 1, "description": "int (an integer)"})js"));
    EXPECT_EQ(of["big"]["minimum"], std::numeric_limits<std::int64_t>::min());
    EXPECT_EQ(of["big"]["maximum"], std::numeric_limits<std::int64_t>::max());
    EXPECT_EQ(of["length"], json::parse(R"js({"type": "number", "minimum": 0, "maximum": 1,
        "default": 0.5, "description": "double (a number, 0 to 1 m)"})js"));
    EXPECT_TRUE(of["length"]["maximum"].is_number_integer()) << "1, not 1.0";
    EXPECT_EQ(of["mode"]["anyOf"][0], json::parse(R"js({"enum": ["slow", "fast"]})js"));
    EXPECT_EQ(of["mode"]["default"], "slow");
    EXPECT_EQ(of["path"]["type"], "string");
    EXPECT_EQ(of["counts"], json::parse(R"js({"type": "array", "default": [1, 2],
        "items": {"type": "integer", "minimum": 0, "maximum": 9},
        "description": "ints (a list of integers, 0 to 9)"})js"));
    EXPECT_EQ(of["flags"]["default"], json::parse("[true, false]"));
    EXPECT_EQ(of["modes"]["items"], (json{{"anyOf", of["mode"]["anyOf"]}}));
}

TEST(Schema, leaves_out_bounds_that_bound_nothing) {
    StageSpec spec = describe_stage<Kinds>("source.kinds");
    for (ParamSpec& param : spec.params)
        if (param.name == "length") param.max = std::numeric_limits<double>::infinity();
    Registry registry;
    registry.add(spec);
    const json schema = json::parse(pipeline_schema(registry));
    const json length = definition(schema, "source.kinds")["params"]["properties"]["length"];
    EXPECT_EQ(length["minimum"], 0);
    EXPECT_FALSE(length.contains("maximum"));
}

TEST(Schema, of_inputs_asks_for_the_required_ones_and_wires_that_fit) {
    const json schema = pipeline_json();
    const json boards = definition(schema, "detector.boards")["in"];
    EXPECT_EQ(boards["required"], json::parse(R"(["cloud"])"));
    EXPECT_EQ(boards["additionalProperties"], false);
    EXPECT_EQ(schema["definitions"]["detector.boards"]["required"], json::parse(R"(["in"])"));
    EXPECT_EQ(boards["properties"]["cloud"]["pattern"], "^[a-z][a-z0-9_]*\\.(cloud)$");
    EXPECT_EQ(boards["properties"]["cloud"]["description"], "points (Cloud)");
    EXPECT_EQ(boards["properties"]["images"]["description"], "pictures (Images, optional)");
    const json poses = definition(schema, "solver.mean")["in"]["properties"]["poses"];
    ASSERT_EQ(poses["anyOf"].size(), 2U);
    EXPECT_EQ(poses["anyOf"][1]["items"], poses["anyOf"][0]);
    EXPECT_EQ(poses["anyOf"][1]["minItems"], 1);
    // All optional: one of them at least.
    EXPECT_EQ(definition(schema, "sink.viewer")["in"]["minProperties"], 1);
    EXPECT_EQ(schema["definitions"]["sink.viewer"]["required"], json::parse(R"(["in"])"));
    // A source takes none and needs no `in`.
    EXPECT_EQ(definition(schema, "source.scene")["in"],
              json::parse(R"({"properties": {}, "additionalProperties": false})"));
    EXPECT_FALSE(schema["definitions"]["source.scene"].contains("required"));
}

TEST(Schema, picks_a_stages_definition_by_its_type) {
    const json stage = pipeline_json()["definitions"]["stage"];
    EXPECT_EQ(stage["required"], json::parse(R"(["type"])"));
    ASSERT_EQ(stage["allOf"].size(), registry().types().size());
    EXPECT_EQ(stage["properties"]["type"]["enum"], json(registry().types()));
    EXPECT_EQ(stage["properties"]["type"]["enumDescriptions"].size(), registry().types().size());
    EXPECT_EQ(stage["allOf"][0], json::parse(R"({
        "if": {"properties": {"type": {"const": "detector.boards"}}, "required": ["type"]},
        "then": {"$ref": "#/definitions/detector.boards"}})"));
}

TEST(Schema, of_patches_asks_for_nothing_and_takes_null) {
    const json schema = json::parse(patch_schema(registry()));
    EXPECT_FALSE(schema.contains("required"));
    EXPECT_EQ(schema["properties"]["seed"]["type"], json::parse(R"(["integer", "null"])"));
    EXPECT_EQ(schema["properties"]["stages"]["type"], "object");
    const json& stage = schema["definitions"]["stage"];
    EXPECT_FALSE(stage.contains("required"));
    EXPECT_EQ(stage["type"], json::parse(R"(["object", "null"])"));
    EXPECT_EQ(stage["properties"]["type"]["type"], "string") << "a stage keeps a type";
    const json in = definition(schema, "detector.boards")["in"];
    EXPECT_FALSE(in.contains("required"));
    EXPECT_EQ(in["additionalProperties"], json::parse(R"({"type": "null"})"));
}

TEST(Schema, does_not_depend_on_the_order_of_registering) {
    Registry turned;
    const auto all = registry().all();
    for (auto stage = all.rbegin(); stage != all.rend(); ++stage) turned.add(**stage);
    EXPECT_EQ(pipeline_schema(turned), pipeline_schema(registry()));
    EXPECT_EQ(patch_schema(turned), patch_schema(registry()));
}

TEST(Schema, of_no_stages_is_one_still) {
    const json schema = json::parse(pipeline_schema(Registry{}));
    EXPECT_FALSE(schema["definitions"]["stage"].contains("allOf"));
    EXPECT_FALSE(schema["definitions"]["stage"]["properties"]["type"].contains("enum"));
}

}  // namespace
}  // namespace petal::pipeline_fakes
