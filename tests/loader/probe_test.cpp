// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <string>

#include "cases.hpp"
#include "plugin_probe.hpp"

namespace petal {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;
using Outcome = ProbeResult::Outcome;
using testing::plugin_case;
using testing::plugin_file;

TEST(Probe, AGoodPluginIsOk) {
    const ProbeResult result = probe(plugin_file("good"));
    EXPECT_EQ(result.outcome, Outcome::ok) << result.reason;
    EXPECT_EQ(result.reason, "");
    EXPECT_THAT(result.types, ElementsAre("toys.good"));
}

TEST(Probe, TellsWhatRegisteringThrew) {
    const ProbeResult result = probe(plugin_file("throws"));
    EXPECT_EQ(result.outcome, Outcome::refused);
    EXPECT_THAT(result.reason, HasSubstr("the toy box is empty"));
}

TEST(Probe, DoesNotOpenWhatDoesNotFit) {
    const ProbeResult result = probe(plugin_file("other_abi"));
    EXPECT_EQ(result.outcome, Outcome::refused);
    EXPECT_THAT(result.reason, HasSubstr("framework ABI"));
}

TEST(Probe, NamesTheSignalAndKeepsTheLastWords) {
    const ProbeResult result = probe(plugin_file("aborts"));
    EXPECT_EQ(result.outcome, Outcome::crashed);
    EXPECT_THAT(result.reason, AllOf(HasSubstr("signal 6"), HasSubstr("Aborted")));
    EXPECT_THAT(result.output, HasSubstr("toys everywhere"));
}

// Status 0 without an answer is no success.
TEST(Probe, AnExitIsACrash) {
    const ProbeResult result = probe(plugin_file("exits"));
    EXPECT_EQ(result.outcome, Outcome::crashed);
    EXPECT_THAT(result.reason, HasSubstr("ended its process with status 0"));
}

TEST(Probe, EndsWhatHangs) {
    using std::chrono::milliseconds;
    const auto begin = std::chrono::steady_clock::now();
    const ProbeResult result = probe(plugin_file("hangs"), milliseconds(300));
    EXPECT_EQ(result.outcome, Outcome::hung);
    EXPECT_THAT(result.reason, HasSubstr("within 0.300 s"));
    // The limit and the time to kill a process; generous for a busy machine.
    EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(10));
}

TEST(Probe, TellsATypeThatTwoLibrariesHave) {
    const auto all = probe_all({plugin_case("same_type_a"), plugin_case("same_type_b")});
    ASSERT_THAT(all, SizeIs(2));
    EXPECT_THAT(all[0].clashes, IsEmpty());
    EXPECT_EQ(all[1].result.outcome, Outcome::ok);
    EXPECT_THAT(all[1].clashes,
                ElementsAre(AllOf(HasSubstr("'toys.same'"), HasSubstr("same_type_a/first.so"))));
}

TEST(Probe, GoesOnAfterACrash) {
    const auto all =
        probe_all({plugin_case("aborts"), plugin_case("no_library"), plugin_case("good")});
    ASSERT_THAT(all, SizeIs(3));
    EXPECT_EQ(all[0].result.outcome, Outcome::crashed);
    EXPECT_EQ(all[1].result.outcome, Outcome::refused);
    EXPECT_EQ(all[2].result.outcome, Outcome::ok);
    EXPECT_EQ(all[2].library.filename(), "good.so");
}

}  // namespace
}  // namespace petal
