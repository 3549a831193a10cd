// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "petal/json_value.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <functional>

#include "petal/error.hpp"

namespace petal {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

class JsonValueTest : public ::testing::Test {
   protected:
    fs::path file(const std::string& name, const std::string& text) const {
        fs::create_directories(folder_);
        std::ofstream(folder_ / name) << text;
        return folder_ / name;
    }
    JsonValue value(const std::string& text) const {
        return JsonValue::read(file("a.json", text), "thing");
    }
    static std::string message(const std::function<void()>& code) {
        try {
            code();
        } catch (const Error& e) {
            return e.what();
        }
        return "no error";
    }
    void TearDown() override { fs::remove_all(folder_); }

   private:
    fs::path folder_ = fs::path(::testing::TempDir()) /
                       (std::string("json_value_") +
                        ::testing::UnitTest::GetInstance()->current_test_info()->name());
};

TEST_F(JsonValueTest, ReadsEachKind) {
    const JsonValue v = value(R"({"n": 2.5, "i": 7, "b": true, "t": "word", "p": [1, 2],
                                  "q": [1, 2.5, -3], "l": [{"x": 1}, {"x": 2}]} // a comment)");
    EXPECT_EQ(v.at("n").number(), 2.5);
    EXPECT_EQ(v.at("i").number(0, 10, "m"), 7.0);
    EXPECT_EQ(v.at("i").integer(0, 10), 7);
    EXPECT_TRUE(v.at("b").boolean());
    EXPECT_EQ(v.at("t").choice({"word", "other"}), "word");
    EXPECT_EQ(v.at("p").vector2(), Eigen::Vector2d(1, 2));
    EXPECT_EQ(v.at("q").vector3(), Eigen::Vector3d(1, 2.5, -3));
    ASSERT_EQ(v.at("l").list().size(), 2U);
    EXPECT_EQ(v.at("l").list()[1].at("x").number(), 2.0);
    EXPECT_EQ(v.at("l").list()[1].at("x").path(), "l[1].x");
    EXPECT_FALSE(v.find("absent"));
    EXPECT_TRUE(v.is_object());
    EXPECT_FALSE(v.at("l").is_object());
    EXPECT_EQ(v.at("l").list()[0].keys(), std::vector<std::string>{"x"});
    EXPECT_EQ(value(R"({"b": 1, "a": {"c": 2}})").keys(), (std::vector<std::string>{"b", "a"}));
}

TEST_F(JsonValueTest, AMessageTellsFileLineAndPath) {
    const JsonValue v = value("{\n \"boards\": [\n  {\"yaw_deg\": 200}]}");
    const JsonValue yaw = v.at("boards").list()[0].at("yaw_deg");
    EXPECT_THAT(message([&] { yaw.number(-180, 180, "deg"); }),
                HasSubstr("a.json:3: boards[0].yaw_deg is 200 deg; expected -180 to 180 deg"));
    EXPECT_THAT(message([&] { v.at("board"); }), HasSubstr("a.json:1: lacks the key 'board'"));
    EXPECT_THAT(
        message([&] {
            v.only({"board", "name"});
        }),
        HasSubstr("a.json:2: boards is not known here; expected one of board, name; did you "
                  "mean 'board'?"));
}

TEST_F(JsonValueTest, WrongKindsAreRefused) {
    const JsonValue v = value(R"({"t": "2", "n": 3.5, "e": "", "l": [1, "b"]})");
    EXPECT_THAT(message([&] { v.at("t").number(); }), HasSubstr("expected a number"));
    EXPECT_THAT(message([&] { v.at("n").integer(0, 9); }),
                HasSubstr("expected a whole number, 0 to 9"));
    EXPECT_THAT(message([&] { v.at("n").boolean(); }), HasSubstr("expected true or false"));
    EXPECT_THAT(message([&] { v.at("e").text(); }), HasSubstr("not empty"));
    EXPECT_THAT(message([&] { v.at("l").vector2(); }), HasSubstr("[x, y]"));
    EXPECT_THAT(message([&] { v.at("l").vector3(); }), HasSubstr("list of 3 numbers"));
    EXPECT_THAT(message([&] { v.at("n").list(); }), HasSubstr("expected a list"));
    EXPECT_THAT(message([&] { v.at("n").only({"x"}); }), HasSubstr("expected an object"));
    EXPECT_THAT(message([&] { v.at("t").choice({"a", "b"}); }), HasSubstr("expected one of a, b"));
}

TEST_F(JsonValueTest, WhatIsNoObjectOfOnceGivenKeysIsRefused) {
    EXPECT_THAT(message([&] { value("[1]"); }), HasSubstr("expected an object"));
    EXPECT_THAT(message([&] { value("{\"a\": 1, \"a\": 2}"); }), HasSubstr("'a'"));
    EXPECT_THAT(message([&] { value("{\"a\": "); }), HasSubstr("a.json:1"));
    EXPECT_THAT(message([&] { value("{\"a\": 1e999}"); }), HasSubstr("does not fit a double"));
    EXPECT_THAT(message([&] { JsonValue::read("/no/such.json", "thing"); }),
                HasSubstr("thing /no/such.json: no such file"));
}

TEST_F(JsonValueTest, ADocumentIsLaidOverAnother) {
    const JsonValue base =
        JsonValue::read(file("base.json", R"({"light": {"lamp": 1, "sky": 2}, "x": 1})"), "thing");
    const JsonValue top =
        JsonValue::read(file("top.json", "{\"light\": {\"lamp\": 3},\n\"x\": null}"), "thing");
    const JsonValue both = top.over(base);
    EXPECT_EQ(both.at("light").at("lamp").number(), 3.0);
    EXPECT_EQ(both.at("light").at("sky").number(), 2.0);
    EXPECT_FALSE(both.has("x"));
    EXPECT_THAT(message([&] { both.at("light").at("lamp").number(0, 1, "1"); }),
                HasSubstr("top.json:1"));
    EXPECT_THAT(message([&] { both.at("light").at("sky").number(0, 1, "1"); }),
                HasSubstr("base.json:1"));
    const JsonValue wrong = JsonValue::read(file("wrong.json", R"({"y": null})"), "thing");
    EXPECT_THAT(message([&] { wrong.over(base); }),
                HasSubstr("null removes 'y', which is not there"));
}

}  // namespace
}  // namespace petal
