// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include <gmock/gmock.h>

#include <vector>

#include "petal_process.hpp"

// Plugins that are bad on purpose (tests/loader/plugins), told apart by what the program itself
// says and by its exit code.

namespace petal::testing {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::MatchesRegex;
using ::testing::Not;

const fs::path kPlugins = fs::path(PETAL_BUILD_DIR) / "tests" / "loader";

class BadPlugin : public PetalProcess {
   protected:
    void write(const std::string& name, const std::string& text) const {
        std::ofstream(folder_ / name) << text;
    }
    /// petal with the plugins of one or more cases, searched before petal's own.
    Ended petal_with(const std::vector<std::string>& cases, const std::string& arguments) const {
        std::string options;
        for (const std::string& name : cases)
            options += "--plugin-path '" + (kPlugins / name).string() + "' ";
        return petal(options + arguments);
    }
    static std::string library(const std::string& name) {
        return fs::canonical(kPlugins / name / (name + ".so")).string();
    }
};

// --- libraries that are refused ------------------------------------------------------------------

struct Refused {
    const char* name;
    const char* reason;
};
class RefusedLibrary : public BadPlugin, public ::testing::WithParamInterface<Refused> {};

TEST_P(RefusedLibrary, IsToldByEveryCommandAndDoesNoHarm) {
    const auto [name, reason] = GetParam();
    if (!fs::exists(kPlugins / name)) GTEST_SKIP() << "not built under a sanitizer";
    write("p.json", R"({"petal": 1, "stages": {"a": {"type": "toys.of_this_library"}}})");
    const auto told = AllOf(HasSubstr(library(name)), HasSubstr(reason));
    for (const char* command : {"check p.json", "run p.json --out out", "show p.json"}) {
        const Ended ended = petal_with({name}, command);
        EXPECT_EQ(ended.exit_code, 3) << command;
        EXPECT_THAT(ended.err, AllOf(HasSubstr("p.json:1: stages.a.type: unknown stage type "
                                               "'toys.of_this_library'"),
                                     HasSubstr("libraries that were refused and may hold the "
                                               "missing type:"),
                                     told))
            << command;
    }
    EXPECT_FALSE(fs::exists(folder_ / "out"));
    const Ended plugins = petal_with({name}, "plugins");
    EXPECT_EQ(plugins.exit_code, 0) << plugins.err;
    EXPECT_THAT(plugins.out, AllOf(HasSubstr("refused:"), told, HasSubstr("petal_detectors.so")));
    const Ended probed = petal_with({name}, "plugins --probe");
    EXPECT_EQ(probed.exit_code, 0) << probed.err;
    EXPECT_THAT(probed.out, AllOf(HasSubstr("refused  " + library(name)), HasSubstr(reason)));
    EXPECT_EQ(petal_with({name}, "check " + pipeline("letter_indoor.json")).exit_code, 0);
}

INSTANTIATE_TEST_SUITE_P(
    BadPlugin, RefusedLibrary,
    ::testing::Values(
        Refused{"other_abi", "was built differently from this petal: framework ABI: plugin "},
        Refused{"other_alignment", "Eigen alignment: plugin 64 bytes, petal "},
        Refused{"old_strings", "std::string ABI: plugin old (_GLIBCXX_USE_CXX11_ABI=0), petal new"},
        Refused{"sanitized", "sanitizers: plugin address, petal none"},
        Refused{"no_library", "is not a shared library: it has no ELF header"},
        Refused{"no_record", "no petal plugin"},
        Refused{"no_register", "has a plugin record but no function petal_plugin_register"},
        Refused{"missing_symbol", "cannot be opened: undefined symbol"},
        Refused{"throws", "failed while it registered its stages: the toy box is empty"},
        Refused{"throws_int",
                "failed while it registered its stages: it threw what is no "
                "std::exception"},
        Refused{"throws_in_describe", "failed while it registered its stages: beyond words"},
        Refused{"incomplete", "stage 'toys.incomplete' is not declared completely"}),
    [](const auto& one) { return std::string(one.param.name); });

TEST_F(BadPlugin, InTheEnvironmentsFolderIsToldToo) {
    write("p.json", R"({"petal": 1, "stages": {"a": {"type": "toys.half"}}})");
    ::setenv("PETAL_PLUGIN_PATH", (kPlugins / "throws").c_str(), 1);
    const Ended ended = petal("check p.json");
    ::setenv("PETAL_PLUGIN_PATH", "plugins", 1);
    const Ended relative = petal("check p.json");
    ::unsetenv("PETAL_PLUGIN_PATH");
    EXPECT_EQ(ended.exit_code, 3);
    EXPECT_THAT(ended.err, HasSubstr("the toy box is empty"));
    EXPECT_EQ(relative.exit_code, 2);
    EXPECT_THAT(relative.err, HasSubstr("PETAL_PLUGIN_PATH holds the relative folder 'plugins'"));
}

// --- libraries that end or block their host ------------------------------------------------------

TEST_F(BadPlugin, ThatEndsItsHostIsNamedByTheProbe) {
    const Ended aborts = petal_with({"aborts", "good"}, "plugins --probe");
    EXPECT_EQ(aborts.exit_code, 3);
    EXPECT_THAT(aborts.out,
                AllOf(HasSubstr("crashed  " + library("aborts") +
                                "\n    ended its process by signal 6 (Aborted) while it was "
                                "loaded\n    printed: toys everywhere\n"),
                      HasSubstr("ok       " + library("good") + "\n    toys.good\n")));
    const Ended exits = petal_with({"exits"}, "plugins --probe");
    EXPECT_EQ(exits.exit_code, 3);
    EXPECT_THAT(exits.out, HasSubstr("crashed  " + library("exits") +
                                     "\n    ended its process with status 0 while it was loaded"));
}

TEST_F(BadPlugin, ThatHangsIsNamedByTheProbe) {
    const Ended hangs = petal_with({"hangs", "good"}, "plugins --probe");
    EXPECT_EQ(hangs.exit_code, 3);
    EXPECT_THAT(hangs.out, AllOf(HasSubstr("hung     " + library("hangs") +
                                           "\n    did not finish loading within 10 s\n"),
                                 HasSubstr("ok       " + library("good"))));
}

// --- one type in two libraries -------------------------------------------------------------------

TEST_F(BadPlugin, OneTypeInTwoLibrariesStopsEverythingAndNamesBoth) {
    const std::string first = fs::canonical(kPlugins / "same_type_a" / "first.so").string();
    const std::string second = fs::canonical(kPlugins / "same_type_b" / "second.so").string();
    const std::vector<std::string> both{"same_type_a", "same_type_b"};
    const std::string clash = "stage type 'toys.same' is in two libraries, " + first + " and " +
                              second + "; rename one of them or take one library away\n";
    for (const std::string& command : {"check " + pipeline("letter_indoor.json"),
                                       "run " + pipeline("letter_indoor.json") + " --out out",
                                       std::string("stages"), std::string("schema")}) {
        const Ended ended = petal_with(both, command);
        EXPECT_EQ(ended.exit_code, 3) << command;
        EXPECT_EQ(ended.err, "petal: " + clash) << command;
    }
    // What is there is listed all the same.
    const Ended plugins = petal_with(both, "plugins");
    EXPECT_EQ(plugins.exit_code, 3);
    EXPECT_THAT(plugins.out,
                AllOf(MatchesRegex(".*  first +1.2.3  " + first + "\n +toys.same\n.*"),
                      MatchesRegex(".*  second +1.2.3  " + second + "\n +toys.same\n.*"),
                      HasSubstr("petal_detectors.so"),
                      HasSubstr("nothing can run with these:\n  " + clash)));
    const Ended probed = petal_with(both, "plugins --probe");
    EXPECT_EQ(probed.exit_code, 3);
    EXPECT_THAT(probed.out,
                AllOf(HasSubstr("ok       " + first + "\n    toys.same\n"),
                      HasSubstr("ok       " + second +
                                "\n    toys.same\n    stage type 'toys.same' is in " + first +
                                " too; rename one of them or take one library away\n")));
}

// --- stages that break their contract ------------------------------------------------------------

struct Fault {
    const char* name;
    const char* stage;  ///< type and params of the stage `toy`
    int exit_code;
    const char* message;
};
class FaultyStage : public BadPlugin, public ::testing::WithParamInterface<Fault> {};

TEST_P(FaultyStage, IsNamedWithItsTypeAndFrame) {
    const Fault& fault = GetParam();
    write("p.json", std::string(R"({"petal": 1, "stages": {
  "frames": {"type": "faulty.frames"},
  "toy": {"in": {"toy": "frames.toy"}, )") +
                        fault.stage + "}\n}}\n");
    for (const char* threads : {"1", "4"}) {
        const Ended ended = petal_with(
            {"faulty_stages"}, std::string("run p.json --force --out out --threads ") + threads);
        EXPECT_EQ(ended.exit_code, fault.exit_code) << ended.err;
        EXPECT_THAT(ended.err, HasSubstr(fault.message));
        EXPECT_THAT(ended.err, Not(HasSubstr("terminate")));
    }
    if (fault.exit_code == 1) {
        EXPECT_THAT(read_text(folder_ / "out" / "run.json"), HasSubstr("\"failed\""));
    }
}

INSTANTIATE_TEST_SUITE_P(
    BadPlugin, FaultyStage,
    ::testing::Values(
        Fault{"throws_std_in_run", R"("type": "faulty.throws")", 1,
              "error: toy (faulty.throws), frame 1 'second': the spring is broken\n"},
        Fault{"throws_petal_in_run", R"("type": "faulty.throws", "params": {"what": "petal"})", 1,
              "error: toy (faulty.throws), frame 1 'second': the battery is empty\n"},
        Fault{"throws_int_in_run", R"("type": "faulty.throws", "params": {"what": "int"})", 1,
              "error: toy (faulty.throws), frame 1 'second': threw something that is no "
              "std::exception\n"},
        Fault{"throws_std_in_finish", R"("type": "faulty.throws", "params": {"where": "finish"})",
              1, "error: toy (faulty.throws): the spring is broken\n"},
        Fault{"throws_petal_in_finish",
              R"("type": "faulty.throws", "params": {"where": "finish", "what": "petal"})", 1,
              "error: toy (faulty.throws): the battery is empty\n"},
        Fault{"throws_int_in_finish",
              R"("type": "faulty.throws", "params": {"where": "finish", "what": "int"})", 1,
              "error: toy (faulty.throws): threw something that is no std::exception\n"},
        Fault{"throws_std_in_constructor",
              R"("type": "faulty.throws", "params": {"where": "constructor"})", 1,
              "error: toy (faulty.throws), while it was made: the spring is broken\n"},
        Fault{"throws_petal_in_constructor",
              R"("type": "faulty.throws", "params": {"where": "constructor", "what": "petal"})", 1,
              "error: toy (faulty.throws), while it was made: the battery is empty\n"},
        Fault{"throws_int_in_constructor",
              R"("type": "faulty.throws", "params": {"where": "constructor", "what": "int"})", 1,
              "error: toy (faulty.throws), while it was made: threw something that is no "
              "std::exception\n"},
        Fault{"throws_std_in_check", R"("type": "faulty.throws", "params": {"where": "check"})", 2,
              "p.json:3: stages.toy.params: the check of faulty.throws (plugin faulty_stages) "
              "failed: the spring is broken\n"},
        Fault{"throws_int_in_check",
              R"("type": "faulty.throws", "params": {"where": "check", "what": "int"})", 2,
              "p.json:3: stages.toy.params: the check of faulty.throws (plugin faulty_stages) "
              "failed: it threw what is no std::exception\n"},
        Fault{"writes_no_packet", R"("type": "faulty.writes", "params": {"fault": "nothing"})", 1,
              "error: toy (faulty.writes), frame 0 'first': the stage wrote no packet on port "
              "'copy'; a stage that finds nothing writes an empty Toy\n"},
        Fault{"writes_a_wrong_type",
              R"("type": "faulty.writes", "params": {"fault": "wrong_type"})", 1,
              "error: toy (faulty.writes), frame 0 'first': the stage wrote Doll on port 'copy', "
              "which it declares as Toy\n"},
        Fault{"writes_twice", R"("type": "faulty.writes", "params": {"fault": "twice"})", 1,
              "error: toy (faulty.writes), frame 0 'first': the stage wrote port 'copy' twice for "
              "one frame\n"},
        Fault{
            "writes_an_undeclared_port",
            R"("type": "faulty.writes", "params": {"fault": "undeclared"})", 1,
            "error: toy (faulty.writes), frame 0 'first': the stage wrote on port 'shadow', which "
            "it does not declare as an output\n"},
        Fault{"writes_in_finish", R"("type": "faulty.writes", "params": {"fault": "in_finish"})", 1,
              "error: toy (faulty.writes): the stage wrote port 'copy' in finish(), where nobody "
              "can read it; only stages that gather write there\n"},
        Fault{"reads_another_type",
              R"("type": "faulty.writes", "params": {"fault": "reads_other"})", 1,
              "error: toy (faulty.writes), frame 0 'first': port 'toy' holds Toy, the stage asked "
              "for Doll\n"},
        Fault{"reads_an_undeclared_port",
              R"("type": "faulty.writes", "params": {"fault": "reads_undeclared"})", 1,
              "error: toy (faulty.writes), frame 0 'first': input port 'game' is not wired; wire "
              "it, or ask wired() first\n"},
        Fault{"ends_data_that_is_not_its_own",
              R"("type": "faulty.writes", "params": {"fault": "ends_data"})", 1,
              "error: toy (faulty.writes), frame 0 'first': end_of_data() is for sources: this "
              "stage has inputs\n"}),
    [](const auto& one) { return std::string(one.param.name); });

TEST_F(BadPlugin, SourceThatWritesAndEndsAtOnce) {
    write("p.json", R"({"petal": 1, "stages": {"s": {"type": "faulty.writes_at_the_end"}}})");
    const Ended ended = petal_with({"faulty_stages"}, "run p.json --out out");
    EXPECT_EQ(ended.exit_code, 1);
    EXPECT_THAT(ended.err,
                HasSubstr("error: s (faulty.writes_at_the_end), frame 0: the stage wrote "
                          "port 'toy' in the call that ended its data\n"));
}

}  // namespace
}  // namespace petal::testing
