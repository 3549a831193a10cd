// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "registry.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <string>

#include "petal/error.hpp"

namespace petal {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

PortSpec port(const std::string& name) {
    return {name, "Cloud", "points", false, false};
}

ParamSpec real(const std::string& name, double value) {
    ParamSpec param;
    param.name = name;
    param.kind = Kind::real;
    param.unit = "m";
    param.min = 0.0;
    param.max = 10.0;
    param.doc = "a length";
    param.default_value = value;
    return param;
}

StageSpec complete(const std::string& type = "filter.radius") {
    StageSpec spec;
    spec.type = type;
    spec.summary = "Drops points.";
    spec.role = "outlier_remover";
    spec.inputs = {port("cloud")};
    spec.outputs = {port("cloud")};
    spec.params = {real("radius", 0.15)};
    return spec;
}

std::string refusal(StageSpec spec) {
    Registry registry;
    try {
        registry.add(std::move(spec));
    } catch (const Error& error) {
        EXPECT_TRUE(registry.types().empty());
        return error.what();
    }
    return "no error";
}

std::string refusal_after(const std::function<void(StageSpec&)>& spoil) {
    StageSpec spec = complete();
    spoil(spec);
    return refusal(std::move(spec));
}

TEST(Registry, KeepsStagesSorted) {
    Registry registry;
    registry.add(complete("filter.b"));
    registry.add(complete("filter.a"));
    EXPECT_THAT(registry.types(), ElementsAre("filter.a", "filter.b"));
    ASSERT_EQ(registry.all().size(), 2U);
    EXPECT_EQ(registry.all()[0], registry.find("filter.a"));
    EXPECT_EQ(registry.find("filter.c"), nullptr);
}

TEST(Registry, RefusesATakenTypeAndNamesBothLibraries) {
    Registry registry;
    StageSpec first = complete();
    first.library = "/a/one.so";
    StageSpec second = complete();
    second.library = "/b/two.so";
    registry.add(first);
    try {
        registry.add(second);
        FAIL();
    } catch (const Error& error) {
        EXPECT_THAT(error.what(), AllOf(HasSubstr("'filter.radius'"), HasSubstr("/a/one.so"),
                                        HasSubstr("/b/two.so")));
    }
    try {
        registry.add(first);
        FAIL();
    } catch (const Error& error) {
        EXPECT_THAT(error.what(), HasSubstr("registered twice by /a/one.so"));
    }
}

TEST(Registry, RefusesBadNames) {
    for (const char* type : {"", "radius", "filter.", ".radius", "Filter.radius", "filter.radius.x",
                             "filter.radius-x", "filter.r adius"})
        EXPECT_THAT(refusal(complete(type)), HasSubstr("its type is not of the form kind.name"))
            << type;
    EXPECT_THAT(refusal_after([](auto& s) { s.inputs[0].name = "Cloud"; }),
                HasSubstr("input port 'Cloud' is not made of lower case letters"));
    EXPECT_THAT(refusal_after([](auto& s) { s.outputs[0].name = ""; }),
                HasSubstr("output port '' is not made of"));
    EXPECT_THAT(refusal_after([](auto& s) { s.params[0].name = "ra dius"; }),
                HasSubstr("parameter 'ra dius' is not made of"));
    EXPECT_THAT(refusal_after([](auto& s) { s.role = "Remover"; }), HasSubstr("role 'Remover'"));
}

TEST(Registry, RefusesWhatIsNotDocumented) {
    EXPECT_THAT(refusal_after([](auto& s) { s.summary = ""; }), HasSubstr("it has no summary"));
    EXPECT_THAT(refusal_after([](auto& s) { s.inputs[0].doc = ""; }),
                HasSubstr("input port 'cloud' has no documentation"));
    EXPECT_THAT(refusal_after([](auto& s) { s.outputs[0].doc = ""; }),
                HasSubstr("output port 'cloud' has no documentation"));
    EXPECT_THAT(refusal_after([](auto& s) { s.params[0].doc = ""; }),
                HasSubstr("parameter 'radius' has no documentation"));
}

TEST(Registry, RefusesDoublesWithoutUnitOrRange) {
    EXPECT_THAT(refusal_after([](auto& s) { s.params[0].unit = ""; }),
                HasSubstr("parameter 'radius' is a double without a unit"));
    EXPECT_THAT(refusal_after([](auto& s) { s.params[0].min = s.params[0].max = std::nullopt; }),
                HasSubstr("parameter 'radius' is a double without a range"));
    // at_least() alone is a range
    EXPECT_EQ(refusal_after([](auto& s) { s.params[0].max = std::nullopt; }), "no error");
}

TEST(Registry, RefusesDefaultsThatAUserCouldNotGive) {
    EXPECT_THAT(refusal_after([](auto& s) { s.params[0].default_value = 10.5; }),
                HasSubstr("has the default 10.5 above its greatest value 10"));
    EXPECT_THAT(refusal_after([](auto& s) { s.params[0].default_value = -0.1; }),
                HasSubstr("has the default -0.1 below its least value 0"));
    EXPECT_THAT(refusal_after([](auto& s) {
                    s.params[0].default_value = std::numeric_limits<double>::quiet_NaN();
                }),
                HasSubstr("not a finite number"));
    EXPECT_THAT(refusal_after([](auto& s) {
                    s.params[0].list = true;
                    s.params[0].default_value = std::vector<double>{1.0, 11.0};
                }),
                HasSubstr("has the default 11 above"));
    EXPECT_THAT(refusal_after([](auto& s) { s.params[0].min = 20.0; }),
                HasSubstr("has the empty range 20 to 10"));
    EXPECT_THAT(refusal_after([](auto& s) {
                    s.params[0].kind = Kind::choice;
                    s.params[0].choices = {"huber", "none"};
                    s.params[0].default_value = std::string("cauchy");
                }),
                HasSubstr("'cauchy', which is none of its choices (huber, none)"));
    EXPECT_THAT(refusal_after([](auto& s) {
                    s.make_params = [] { return std::shared_ptr<void>(); };
                    s.check_params = [](const void*) {
                        return std::vector<std::string>{"radius must be less than reach"};
                    };
                }),
                HasSubstr("its defaults break its own check: radius must be less than reach"));
}

TEST(Registry, RefusesWhatIsDeclaredTwiceOrNotAtAll) {
    EXPECT_THAT(refusal_after([](auto& s) { s.params.push_back(s.params[0]); }),
                HasSubstr("parameter 'radius' is declared twice"));
    EXPECT_THAT(refusal_after([](auto& s) { s.inputs.push_back(s.inputs[0]); }),
                HasSubstr("input port 'cloud' is declared twice"));
    EXPECT_THAT(refusal_after([](auto& s) {
                    s.inputs.clear();
                    s.outputs.clear();
                }),
                HasSubstr("it has no port at all"));
}

TEST(Registry, TellsAllThatIsMissingAtOnce) {
    EXPECT_THAT(refusal_after([](auto& s) {
                    s.summary = "";
                    s.params[0].unit = "";
                }),
                AllOf(HasSubstr("stage 'filter.radius'"), HasSubstr("summary"), HasSubstr("unit")));
}

TEST(StageSpec, FindsItsParts) {
    StageSpec spec = complete();
    EXPECT_EQ(spec.find_param("radius"), &spec.params[0]);
    EXPECT_EQ(spec.find_param("cloud"), nullptr);
    EXPECT_EQ(spec.find_input("cloud"), &spec.inputs[0]);
    EXPECT_EQ(spec.find_output("cloud"), &spec.outputs[0]);
    EXPECT_EQ(spec.find_output("planes"), nullptr);
    EXPECT_FALSE(spec.gathers());
    spec.inputs[0].gathers = true;
    EXPECT_TRUE(spec.gathers());
}

TEST(Kind, HasTheWordsOfTheDocumentation) {
    EXPECT_STREQ(to_string(Kind::boolean), "bool");
    EXPECT_STREQ(to_string(Kind::integer), "int");
    EXPECT_STREQ(to_string(Kind::real), "double");
    EXPECT_STREQ(to_string(Kind::text), "string");
    EXPECT_STREQ(to_string(Kind::choice), "choice");
    EXPECT_STREQ(to_string(Kind::path), "path");
}

}  // namespace
}  // namespace petal
