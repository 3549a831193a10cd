// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "merge_patch.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "json_reader.hpp"

namespace petal {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

/// JSON without spaces, to compare trees.
std::string dump(const JsonNode& node) {
    std::string text;
    if (node.is(NodeKind::object)) {
        for (const JsonMember& member : node.members)
            text += (text.empty() ? "" : ",") + ("\"" + member.key + "\":" + dump(member.value));
        return "{" + text + "}";
    }
    if (node.is(NodeKind::array)) {
        for (const JsonNode& element : node.elements)
            text += (text.empty() ? "" : ",") + dump(element);
        return "[" + text + "]";
    }
    return node.is(NodeKind::text) ? "\"" + node.text + "\"" : describe(node);
}

class MergePatch : public ::testing::Test {
   protected:
    JsonNode parse(const std::string& name, const std::string& text) {
        return read_json(text, list_.add_file(name), "", list_).value();
    }
    std::string merged(const std::string& target, const std::string& patch) {
        JsonNode node = parse("target", target);
        merge_object(node, parse("patch", patch), "", list_);
        return dump(node);
    }
    std::string patched(const std::string& pipeline, const std::string& patch) {
        node_ = parse("p.json", pipeline);
        apply_patch(node_, parse("v.json", patch), list_);
        return dump(node_);
    }
    std::vector<std::string> problems() const {
        std::vector<std::string> texts;
        for (const Problem& problem : list_.sorted()) texts.push_back(to_string(problem));
        return texts;
    }

    ProblemList list_;
    JsonNode node_;
};

// RFC 7396, appendix A: those of its examples whose target and patch are objects.
TEST_F(MergePatch, examples_of_the_rfc) {
    EXPECT_EQ(merged(R"({"a":"b"})", R"({"a":"c"})"), R"({"a":"c"})");
    EXPECT_EQ(merged(R"({"a":"b"})", R"({"b":"c"})"), R"({"a":"b","b":"c"})");
    EXPECT_EQ(merged(R"({"a":"b"})", R"({"a":null})"), R"({})");
    EXPECT_EQ(merged(R"({"a":"b","b":"c"})", R"({"a":null})"), R"({"b":"c"})");
    EXPECT_EQ(merged(R"({"a":["b"]})", R"({"a":"c"})"), R"({"a":"c"})");
    EXPECT_EQ(merged(R"({"a":"c"})", R"({"a":["b"]})"), R"({"a":["b"]})");
    EXPECT_EQ(merged(R"({"a":[{"b":"c"}]})", R"({"a":[1]})"), R"({"a":[1]})");
    EXPECT_EQ(merged(R"({"e":null})", R"({"a":1})"), R"({"e":null,"a":1})");
    EXPECT_THAT(problems(), IsEmpty());
    // The same result as in the RFC; a null that removes nothing is told beside it.
    EXPECT_EQ(merged(R"({"a":{"b":"c"}})", R"({"a":{"b":"d","c":null}})"), R"({"a":{"b":"d"}})");
    EXPECT_EQ(merged(R"({})", R"({"a":{"bb":{"ccc":null}}})"), R"({"a":{"bb":{}}})");
    EXPECT_EQ(problems().size(), 2U);
}

TEST_F(MergePatch, values_keep_their_origin) {
    EXPECT_EQ(
        patched("{\"seed\": 1,\n\"stages\": {\n\"s\": {\"type\": \"a.b\",\n\"params\": {\"x\": "
                "1,\n\"y\": 2}}}}",
                "\n\n{\"stages\": {\"s\": {\"params\": {\n\"y\": 3,\n\"z\": 4}}}}"),
        R"({"seed":1,"stages":{"s":{"type":"a.b","params":{"x":1,"y":3,"z":4}}}})");
    const JsonNode& params = node_.find("stages")->value.find("s")->value.find("params")->value;
    EXPECT_EQ(list_.where(params.origin), "p.json:4");
    EXPECT_EQ(list_.where(params.find("x")->value.origin), "p.json:4");
    EXPECT_EQ(list_.where(params.find("y")->value.origin), "v.json:4");
    EXPECT_EQ(list_.where(params.find("z")->value.origin), "v.json:5");
}

TEST_F(MergePatch, a_patch_that_sets_type_replaces_params_whole) {
    const std::string stages =
        R"({"stages":{"s":{"type":"a.b","in":{"c":"t.c"},"params":{"x":1}}}})";
    EXPECT_EQ(patched(stages, R"({"stages":{"s":{"params":{"y":2}}}})"),
              R"({"stages":{"s":{"type":"a.b","in":{"c":"t.c"},"params":{"x":1,"y":2}}}})");
    EXPECT_EQ(patched(stages, R"({"stages":{"s":{"type":"a.c","params":{"y":2}}}})"),
              R"({"stages":{"s":{"type":"a.c","in":{"c":"t.c"},"params":{"y":2}}}})");
    EXPECT_EQ(patched(stages, R"({"stages":{"s":{"type":"a.b"}}})"),
              R"({"stages":{"s":{"type":"a.b","in":{"c":"t.c"}}}})");
    EXPECT_THAT(problems(), IsEmpty());
}

TEST_F(MergePatch, null_removes_stages_and_wires_and_leaves_a_trace) {
    EXPECT_EQ(
        patched(R"({"stages":{"s":{"type":"a.b","in":{"c":"t.c","d":"t.d"}},"t":{"type":"a.t"}}})",
                "{\"stages\":{\n\"t\":null,\n\"s\":{\"in\":{\"c\":null}}}}"),
        R"({"stages":{"s":{"type":"a.b","in":{"d":"t.d"}}}})");
    const JsonNode& stages = node_.find("stages")->value;
    ASSERT_NE(stages.find_removed("t"), nullptr);
    EXPECT_EQ(list_.where(stages.find_removed("t")->origin), "v.json:2");
    EXPECT_NE(stages.find("s")->value.find("in")->value.find_removed("c"), nullptr);
    EXPECT_THAT(problems(), IsEmpty());
}

TEST_F(MergePatch, wrong_names_are_told) {
    patched(R"({"stages":{"solve":{"type":"a.b","in":{"cloud":"t.c"}}}})",
            "{\"stages\":{\n\"slove\":{\"params\":{\"x\":1}},\n\"sovle\":null,\n"
            "\"solve\":{\"in\":{\"clod\":null},\n\"params\":{\"x\":null}}}}");
    EXPECT_THAT(
        problems(),
        ElementsAre(
            "v.json:2: stages.slove: no stage 'slove' to change; expected a type for a new "
            "stage, or an id of the pipeline; did you mean 'solve'?",
            "v.json:3: stages.sovle: null removes 'sovle', which is not there; expected "
            "solve; did you mean 'solve'?",
            "v.json:4: stages.solve.in.clod: null removes 'clod', which is not there; "
            "expected cloud; did you mean 'cloud'?",
            "v.json:5: stages.solve.params.x: null removes 'x', which is not there; expected "
            "nothing to remove"));
}

TEST_F(MergePatch, about_and_seed_are_replaced_version_and_schema_stay) {
    EXPECT_EQ(patched(R"({"petal":1,"$schema":"a","about":"old","seed":3,"stages":{}})",
                      R"({"petal":1,"$schema":"b","about":"new","seed":4})"),
              R"({"petal":1,"$schema":"a","about":"new","seed":4,"stages":{}})");
}

}  // namespace
}  // namespace petal
