// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "json_reader.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <clocale>
#include <limits>
#include <string>
#include <utility>
#include <vector>

namespace petal {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

struct Result {
    std::optional<JsonNode> root;
    std::vector<std::string> problems;
};

Result read(const std::string& text) {
    ProblemList list;
    const std::size_t file = list.add_file("f");
    Result result;
    result.root = read_json(text, file, "", list);
    for (const Problem& problem : list.sorted()) result.problems.push_back(to_string(problem));
    return result;
}

const JsonNode& at(const Result& result, const std::string& key) {
    return result.root->find(key)->value;
}

TEST(JsonReader, keeps_every_kind_in_the_order_of_the_file) {
    const Result result =
        read(R"({"z": null, "a": true, "i": -3, "r": 3.0, "t": "é\n", "l": [1, "x"], "o": {}})");
    ASSERT_TRUE(result.root);
    EXPECT_THAT(result.root->keys(), ElementsAre("z", "a", "i", "r", "t", "l", "o"));
    EXPECT_TRUE(at(result, "z").is(NodeKind::null));
    EXPECT_TRUE(at(result, "a").boolean);
    EXPECT_EQ(at(result, "i").as_int64(), -3);
    EXPECT_FALSE(at(result, "i").as_uint64());
    EXPECT_TRUE(at(result, "r").is(NodeKind::real));
    EXPECT_EQ(at(result, "r").text, "3.0");
    EXPECT_EQ(at(result, "t").text, "é\n");
    EXPECT_EQ(at(result, "l").elements.size(), 2U);
    EXPECT_TRUE(at(result, "o").is(NodeKind::object));
}

TEST(JsonReader, numbers_at_the_end_of_a_line_stay_on_it) {
    const Result result =
        read("{\n\"a\": 1\n,\n\"b\": 2.5\n\n,\"c\": [\n1,\n2\n],\r\n\"d\": \"x\"\n}");
    ASSERT_TRUE(result.root);
    EXPECT_EQ(result.root->origin.line, 1);
    EXPECT_EQ(at(result, "a").origin.line, 2);
    EXPECT_EQ(at(result, "a").text, "1");
    EXPECT_EQ(at(result, "b").origin.line, 4);
    EXPECT_EQ(at(result, "b").real, 2.5);
    EXPECT_EQ(at(result, "c").origin.line, 6);
    EXPECT_EQ(at(result, "c").elements[0].origin.line, 7);
    EXPECT_EQ(at(result, "c").elements[1].origin.line, 8);
    EXPECT_EQ(at(result, "d").origin.line, 10);
}

TEST(JsonReader, key_and_value_may_stand_on_different_lines) {
    const Result result = read("{\"a\":\n\n17}");
    ASSERT_TRUE(result.root);
    EXPECT_EQ(result.root->find("a")->origin.line, 1);
    EXPECT_EQ(at(result, "a").origin.line, 3);
}

TEST(JsonReader, comments_are_passed_over) {
    const Result result = read("// first\n{ // \"b\": 2\n\"a\": 1// one\n}\n// last");
    ASSERT_TRUE(result.root);
    EXPECT_EQ(at(result, "a").origin.line, 3);
    EXPECT_EQ(at(result, "a").text, "1");
}

TEST(JsonReader, duplicate_keys_name_both_lines) {
    const Result result = read("{\"s\": {\"a\": 1,\n\"b\": 2,\n\"a\": 3}}");
    EXPECT_THAT(
        result.problems,
        ElementsAre("f:3: s.a: duplicate key 'a'; it stands in line 1 already; expected once"));
    EXPECT_EQ(at(result, "s").find("a")->value.as_int64(), 3);
    EXPECT_THAT(read("{\"a\": {\"x\": 1}, \"b\": {\"x\": 1}}").problems, IsEmpty());
}

TEST(JsonReader, integers_keep_all_their_digits) {
    const Result result = read(
        "{\"min\": -9223372036854775808, \"max\": 9223372036854775807,"
        " \"over\": 9223372036854775808, \"most\": 18446744073709551615}");
    EXPECT_EQ(at(result, "min").as_int64(), std::numeric_limits<std::int64_t>::min());
    EXPECT_EQ(at(result, "max").as_int64(), std::numeric_limits<std::int64_t>::max());
    EXPECT_FALSE(at(result, "over").as_int64());
    EXPECT_EQ(at(result, "over").as_uint64(), 9223372036854775808U);
    EXPECT_EQ(at(result, "most").as_uint64(), std::numeric_limits<std::uint64_t>::max());
}

TEST(JsonReader, numbers_that_fit_no_type_are_told) {
    const Result result = read(
        "{\"a\": 18446744073709551616,\n\"b\": [-9223372036854775809],\n\"c\": 1e-400,\n\"d\": 1}");
    EXPECT_THAT(
        result.problems,
        ElementsAre(
            "f:1: a: 18446744073709551616 does not fit 64 bits; expected a smaller number",
            "f:2: b[0]: -9223372036854775809 does not fit 64 bits; expected a smaller number",
            "f:3: c: 1e-400 does not fit a double; expected a number of 1e-307 to 1e308 in "
            "size, or 0"));
    ASSERT_TRUE(result.root);
    EXPECT_TRUE(at(result, "a").is(NodeKind::invalid));
    EXPECT_EQ(at(result, "d").as_int64(), 1);
    EXPECT_THAT(read("{\"a\":\n1e400\n}").problems,
                ElementsAre("f:2: a: 1e400 does not fit a double; expected a number up to 1e308"));
}

TEST(JsonReader, depth_is_limited) {
    const std::string open(kDeepestJson, '[');
    const std::string close(kDeepestJson, ']');
    EXPECT_THAT(read(open + close).problems, IsEmpty());
    EXPECT_THAT(read(open + "[]" + close).problems,
                ElementsAre("f:1: [0][0]: nested too deep; expected at most 64 lists and objects "
                            "inside one another"));
    EXPECT_EQ(read(std::string(1000000, '[')).problems.size(), 1U);
    std::string objects;
    for (int i = 0; i < 100; ++i) objects += "{\"a\":";
    EXPECT_THAT(
        read(objects).problems,
        ElementsAre("f:1: a.a: nested too deep; expected at most 64 lists and objects inside "
                    "one another"));
}

TEST(JsonReader, syntax_errors_tell_line_place_and_expectation) {
    const std::vector<std::pair<std::string, std::string>> cases{
        {"{\n\"a\": 1\n\"b\": 2}",
         "f:3: syntax error while parsing object - unexpected string literal; expected '}' or ','"},
        {"[1\n2]",
         "f:2: [0]: syntax error while parsing array - unexpected number literal; expected ']' or "
         "','"},
        {"{\"a\": 1,\n}",
         "f:2: syntax error while parsing object key - unexpected '}'; expected string literal"},
        {"{\"a\"\n 1}",
         "f:2: a: syntax error while parsing object separator - unexpected number literal; "
         "expected "
         "':'"},
        {"{\"a\": {\"b\":\n}}",
         "f:2: a.b: syntax error while parsing value - unexpected '}'; expected '[', '{', or a "
         "literal"},
        {"{\"a\": 1\n",
         "f:1: syntax error while parsing object - unexpected end of input; expected '}' or ','"},
        {"{}\n{}", "f:2: syntax error while parsing value - unexpected '{'; expected end of input"},
        {"{\"a\": 1x}",
         "f:1: syntax error while parsing object - invalid literal; last read: '1x'; expected '}' "
         "or ','"},
        {"{\"a\": NaN}",
         "f:1: a: syntax error while parsing value - invalid literal; last read: '\"a\": N'"},
        {"{\"a\": [1, 2, nul]}",
         "f:1: a[2]: syntax error while parsing value - invalid literal; last read: '2, nul]'"},
        {"{\"a\": [\n}",
         "f:2: a[0]: syntax error while parsing value - unexpected '}'; expected '[', '{', or a "
         "literal"},
        {"{\"a\": 'x'}",
         "f:1: a: syntax error while parsing value - invalid literal; last read: '\"a\": ''"},
        {"{\"a\": \"x\n\"}",
         "f:1: a: syntax error while parsing value - invalid string: control character U+000A (LF) "
         "must be escaped to \\u000A or \\n; last read: '\"x<U+000A>'"},
        {"\x7f"
         "ELF\x02\x01\xff",
         "f:1: syntax error while parsing value - invalid literal; last read: '\\x7f'"},
        {"{\"a\": \"\xff\xfe\"}",
         "f:1: a: syntax error while parsing value - invalid string: ill-formed UTF-8 byte; last "
         "read: '\"?'"},
    };
    for (const auto& [text, expected] : cases) {
        const Result result = read(text);
        EXPECT_FALSE(result.root) << text;
        EXPECT_THAT(result.problems, ElementsAre(expected)) << text;
    }
}

TEST(JsonReader, what_is_no_json_text_at_all) {
    for (const char* text : {"", " \n\t"})
        EXPECT_THAT(read(text).problems, ElementsAre("f:1: is empty; expected JSON"));
    EXPECT_THAT(read("\xEF\xBB\xBF{}").problems,
                ElementsAre("f:1: begins with a byte order mark; expected UTF-8 without one"));
    EXPECT_THAT(read(std::string("{}\0", 3)).problems,
                ElementsAre("f:1: is no text (byte 2 is zero); expected JSON in UTF-8"));
}

TEST(JsonReader, every_prefix_of_a_text_is_a_problem_not_a_crash) {
    const std::string text = "{\"a\": [1.5e3, -2, \"\\u00e9\", {\"b\": null}], \"c\": false} // x";
    for (std::size_t length = 0; length < text.find('}', text.find("false")); ++length)
        EXPECT_EQ(read(text.substr(0, length)).problems.size(), 1U) << text.substr(0, length);
    EXPECT_THAT(read(text).problems, IsEmpty());
}

TEST(JsonReader, numbers_do_not_depend_on_the_locale) {
    const std::string before = std::setlocale(LC_ALL, nullptr);
    const char* found = nullptr;
    for (const char* name : {"de_DE.UTF-8", "de_DE.utf8", "fr_FR.UTF-8", "ps_AF.UTF-8"})
        if (!found) found = std::setlocale(LC_ALL, name);
    if (!found) GTEST_SKIP() << "no locale with a decimal comma is installed";
    const Result result = read("{\"a\": 0.125, \"b\": [2.5e-3]}");
    std::setlocale(LC_ALL, before.c_str());
    ASSERT_TRUE(result.root);
    EXPECT_EQ(at(result, "a").real, 0.125);
    EXPECT_EQ(at(result, "b").elements[0].real, 2.5e-3);
}

}  // namespace
}  // namespace petal
