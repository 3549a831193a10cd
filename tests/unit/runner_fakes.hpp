// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "petal/run.hpp"
#include "petal/spec.hpp"
#include "petal/stage.hpp"

/// Small stages that count and add numbers, to see what the runner does.
namespace runner_fakes {

struct Number {
    std::int64_t value = 0;
};

struct None {};

}  // namespace runner_fakes

namespace petal {
template <>
struct PacketTraits<runner_fakes::Number> {
    static constexpr const char* name = "Number";
    static void seal(runner_fakes::Number&) {}
    static std::size_t bytes(const runner_fakes::Number&) { return sizeof(runner_fakes::Number); }
};
}  // namespace petal

namespace runner_fakes {

struct CountParams {
    int frames = 5;
};

/// 0, 1, 2, ... frames - 1.
class Count final : public petal::Stage {
   public:
    using Params = CountParams;
    static void describe(petal::Spec<Params>& s) {
        s.summary("Counts.");
        s.writes<Number>("number", "the frame's number");
        s.param("frames", &Params::frames).within(0, 1000000).doc("how many");
    }
    explicit Count(Params params) : params_(params) {}
    void run(petal::Run& run) override {
        if (next_ == params_.frames) {
            run.end_of_data();
            return;
        }
        run.write("number", Number{next_});
        run.set_frame("f" + std::to_string(next_), next_ * 0.1);
        ++next_;
    }

   private:
    Params params_;
    int next_ = 0;
};

struct AffineParams {
    int factor = 1;
    int offset = 0;
    int fail_at = -1;
};

class Affine final : public petal::Stage {
   public:
    using Params = AffineParams;
    static void describe(petal::Spec<Params>& s) {
        s.summary("factor * number + offset.");
        s.reads<Number>("number", "in");
        s.writes<Number>("number", "out");
        s.param("factor", &Params::factor).doc("factor");
        s.param("offset", &Params::offset).doc("offset");
        s.param("fail_at", &Params::fail_at).doc("throws on that value");
    }
    explicit Affine(Params params) : params_(params) {}
    void run(petal::Run& run) override {
        const std::int64_t value = run.in<Number>("number").value;
        if (value == params_.fail_at) throw petal::Error("this number is not liked");
        run.write("number", Number{params_.factor * value + params_.offset});
    }

   private:
    Params params_;
};

/// a + b of one frame, and a note that tells which frames met.
class Sum final : public petal::Stage {
   public:
    using Params = None;
    static void describe(petal::Spec<Params>& s) {
        s.summary("a + b.");
        s.reads<Number>("a", "one");
        s.reads<Number>("b", "other");
        s.writes<Number>("sum", "a + b");
    }
    explicit Sum(Params) {}
    void run(petal::Run& run) override {
        run.write("sum", Number{run.in<Number>("a").value + run.in<Number>("b").value});
    }
};

/// The random number of the firing, so that seeds can be compared.
class Dice final : public petal::Stage {
   public:
    using Params = None;
    static void describe(petal::Spec<Params>& s) {
        s.summary("A random number.");
        s.reads<Number>("number", "ignored");
        s.writes<Number>("number", "random");
    }
    explicit Dice(Params) {}
    void run(petal::Run& run) override {
        run.write("number", Number{static_cast<std::int64_t>(run.rng()() % 1000000007U)});
    }
};

/// All numbers, in order, as one text: the product of a run.
class List final : public petal::Stage {
   public:
    using Params = None;
    static void describe(petal::Spec<Params>& s) {
        s.summary("All numbers as text.");
        s.gathers<Number>("numbers", "of all frames");
        s.writes<Number>("total", "their sum");
    }
    explicit List(Params) {}
    void finish(petal::Run& run) override {
        std::string text;
        std::int64_t total = 0;
        for (const auto& packet : run.all<Number>("numbers")) {
            text += packet.frame.name + "=" + std::to_string(packet->value) + " ";
            total += packet->value;
        }
        run.log(petal::LogLevel::info, "list " + text);
        run.note({"numbers", text, "", ""});
        run.write("total", Number{total});
    }
};

/// Reads a once wire; judges the run.
class Judge final : public petal::Stage {
   public:
    using Params = None;
    static void describe(petal::Spec<Params>& s) {
        s.summary("Weak where the total is odd.");
        s.reads<Number>("total", "once");
    }
    explicit Judge(Params) {}
    void run(petal::Run& run) override {
        const std::int64_t total = run.in<Number>("total").value;
        run.verdict(total % 2 == 0 ? petal::Level::usable : petal::Level::weak,
                    {"total " + std::to_string(total)});
    }
};

/// Breaks the contract in the way that `how` names.
struct BadParams {
    std::string how = "nothing";
};
class Bad final : public petal::Stage {
   public:
    using Params = BadParams;
    static void describe(petal::Spec<Params>& s) {
        s.summary("Breaks the contract.");
        s.reads<Number>("number", "in");
        s.writes<Number>("number", "out");
        s.param("how", &Params::how)
            .choices({"nothing", "twice", "unknown_port", "throws_int", "ends"})
            .doc("how");
    }
    explicit Bad(Params params) : params_(std::move(params)) {}
    void run(petal::Run& run) override {
        if (params_.how == "nothing") return;
        if (params_.how == "throws_int") throw 7;
        if (params_.how == "ends") run.end_of_data();
        run.write("number", Number{});
        if (params_.how == "twice") run.write("number", Number{});
        if (params_.how == "unknown_port") run.write("numbers", Number{});
    }

   private:
    Params params_;
};

}  // namespace runner_fakes
