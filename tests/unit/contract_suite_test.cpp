// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "petal/testing/contract_suite.hpp"

#include <gmock/gmock.h>

#include <atomic>
#include <chrono>
#include <thread>

#include "petal/output.hpp"
#include "petal/run.hpp"
#include "runner_fakes.hpp"

namespace petal::testing {
namespace {

using runner_fakes::Number;
using ::testing::AllOf;
using ::testing::Contains;
using ::testing::Field;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

std::atomic<int> calls_of_all{0};

struct SinnerParams {
    std::string sin = "none";
    double level = 1.0;
    int count = 3;
    bool loud = false;
};

/// Keeps the contract, or breaks one point of it. The sin is chosen by the template argument, so
/// that the parameters are those of any stage.
template <int kSin>
class Sinner final : public Stage {
   public:
    using Params = SinnerParams;
    static void describe(Spec<Params>& s) {
        s.summary("Adds one.");
        s.reads<Number>("number", "in");
        s.writes<Number>("number", "out");
        auto level = s.param("level", &Params::level).unit("1").within(0.5, 2.0);
        if constexpr (kSin != 1) level.doc("a level");
        s.param("count", &Params::count).within(0, 9).doc("a count");
        s.param("sin", &Params::sin).choices({"none", "little"}).doc("a choice");
        s.param("loud", &Params::loud).doc("a flag");
        if constexpr (kSin == 2)
            s.check([](const Params& p) { return p.count < 5 ? "count must be 5 or more" : ""; });
    }
    explicit Sinner(Params params) : params_(std::move(params)) {
        if (kSin == 3 && params_.count == 9) throw std::runtime_error("nine is too much");
        if (kSin == 4 && params_.sin == "little") throw std::runtime_error("no such thing");
    }
    void run(Run& run) override {
        const Number& in = run.in<Number>("number");
        std::int64_t value = in.value + 1;
        if (kSin == 5) const_cast<Number&>(in).value += 1;
        if (kSin == 6) value += calls_of_all++;
        if (kSin == 7) value += run.threads();
        if (kSin == 8) value += ++of_this_thread();
        if (kSin == 9 && in.value == 0) throw 7;
        if (kSin == 10 && in.value < 0) throw Error("");
        if (kSin == 11 && run.cancelled()) throw Error("cancelled, but not by Cancelled");
        if (kSin == 12 && in.value == 20 && run.cancelled())  // goes on with what it was at
            std::this_thread::sleep_for(std::chrono::milliseconds(2200));
        if (kSin == 13 && run.frame().number == 0) {
            const auto file = run.output_path("half.txt");
            write_file(file, run.cancelled() ? "ha" : "half");
            run.check_cancelled();
        }
        if (kSin == 14 && params_.level == 2.0) throw std::runtime_error("too high");
        if (kSin == 15 && params_.loud) throw std::runtime_error("too loud");
        if (kSin == 16) run.note({"a note", std::to_string(calls_of_all++), "", ""});
        if (kSin == 17) return;
        run.check_cancelled();
        run.write("number", Number{value});
    }

   private:
    static int& of_this_thread() {
        thread_local int calls = 0;
        return calls;
    }
    Params params_;
};

ContractInputs numbers() {
    ContractInputs inputs;
    inputs.add<Number>("empty", [] { return Number{0}; });
    inputs.add<Number>("typical", [] { return Number{20}; });
    inputs.add<Number>("negative", [] { return Number{-3}; });
    inputs.add_content<Number>([](const Number& n) { return std::to_string(n.value); });
    return inputs;
}

template <int kSin>
std::vector<Violation> violations() {
    return contract_violations(describe_stage<Sinner<kSin>>("fake.sinner"), numbers());
}

auto breaks(const std::string& rule, const std::string& words) {
    return Contains(
        AllOf(Field(&Violation::rule, rule), Field(&Violation::what, HasSubstr(words))));
}

TEST(ContractSuite, AStageThatKeepsItHasNoViolation) {
    for (const Violation& violation : violations<0>())
        ADD_FAILURE() << violation.rule << ": " << violation.what;
}

TEST(ContractSuite, FaultsOfTheDeclarationAreFound) {
    EXPECT_THAT(violations<1>(), breaks("complete declaration", "level"));
    EXPECT_THAT(violations<2>(), breaks("legal defaults", "count must be 5 or more"));
}

TEST(ContractSuite, ValuesAtTheEdgesThatDoNotWorkAreFound) {
    EXPECT_THAT(violations<3>(), breaks("edges", "count = 9"));
    EXPECT_THAT(violations<4>(), breaks("edges", "no such thing"));
    EXPECT_THAT(violations<14>(), breaks("edges", "level = 2"));
    EXPECT_THAT(violations<15>(), breaks("edges", "loud = true"));
}

TEST(ContractSuite, AChangedInputIsFound) {
    EXPECT_THAT(violations<5>(), breaks("inputs unchanged", "changed a packet"));
}

TEST(ContractSuite, OutputsThatDependOnMoreThanInputAndSeedAreFound) {
    EXPECT_THAT(violations<6>(), breaks("same seed, same output", "outputs, notes or verdict"));
    EXPECT_THAT(violations<16>(), breaks("same seed, same output", "outputs, notes or verdict"));
    EXPECT_THAT(violations<7>(), breaks("threads", "four threads instead of one"));
    EXPECT_THAT(violations<8>(), breaks("threads", "each call from another thread"));
}

TEST(ContractSuite, WrongErrorsAreFound) {
    EXPECT_THAT(violations<9>(), breaks("errors", "no std::exception"));
    EXPECT_THAT(violations<10>(), breaks("errors", "with the input 'negative': an error without"));
}

TEST(ContractSuite, StagesThatDoNotCancelAreFound) {
    EXPECT_THAT(violations<11>(), breaks("cancel", "not by Cancelled"));
    EXPECT_THAT(violations<12>(), breaks("cancel", "goes on"));
    EXPECT_THAT(violations<13>(), breaks("cancel", "half.txt"));
}

TEST(ContractSuite, AnOutputThatIsNotWrittenIsFound) {
    EXPECT_THAT(violations<17>(), breaks("errors", "wrote no packet on port 'number'"));
}

TEST(ContractSuite, WhatTheSuiteLacksIsToldToo) {
    ContractInputs inputs = numbers();
    inputs.contents.clear();
    EXPECT_THAT(contract_violations(describe_stage<Sinner<0>>("fake.sinner"), inputs),
                breaks("contents", "packets of type Number"));
    inputs = numbers();
    inputs.packets.clear();
    EXPECT_THAT(contract_violations(describe_stage<Sinner<0>>("fake.sinner"), inputs),
                breaks("inputs", "packet of type Number"));
}

}  // namespace
}  // namespace petal::testing
