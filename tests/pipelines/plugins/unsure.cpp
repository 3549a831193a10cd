// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

// Stages that measure something, slowly and with noise, and may fail or crash: to compare them.

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <memory>
#include <string>
#include <thread>

#include "petal/output.hpp"
#include "petal/plugin.hpp"
#include "petal/printed.hpp"

namespace unsure {

struct Value {
    double value = 0.0;
};

}  // namespace unsure

template <>
struct petal::PacketTraits<unsure::Value> {
    static constexpr const char* name = "UnsureValue";
    static void seal(unsure::Value&) {}
    static std::size_t bytes(const unsure::Value&) { return sizeof(unsure::Value); }
};

namespace unsure {
namespace {

struct DrawParams {
    int pause_ms = 0;
};
class Draw final : public petal::Stage {
   public:
    using Params = DrawParams;
    static void describe(petal::Spec<Params>& s) {
        s.summary("Draws one number of 0 to 1.");
        s.writes<Value>("value", "a number");
        s.param("pause_ms", &Params::pause_ms).within(0, 1000000).doc("before it");
    }
    explicit Draw(Params params) : params_(params) {}
    void run(petal::Run& run) override {
        if (done_) return run.end_of_data();
        done_ = true;
        std::this_thread::sleep_for(std::chrono::milliseconds(params_.pause_ms));
        run.write("value", Value{static_cast<double>(run.rng()() % 1000000U) * 1e-6});
    }

   private:
    Params params_;
    bool done_ = false;
};

struct ResultParams {
    double factor = 1.0;
    int pause_ms = 0;
    double below = 0.0;
    std::string does = "nothing";
};
class Result final : public petal::Stage {
   public:
    using Params = ResultParams;
    static void describe(petal::Spec<Params>& s) {
        s.summary("Writes the number as a metric.");
        s.gathers<Value>("value", "a number");
        s.param("factor", &Params::factor).unit("1").within(0.0, 1e9).doc("times the number");
        s.param("pause_ms", &Params::pause_ms).within(0, 1000000).doc("before it is written");
        s.param("below", &Params::below).unit("1").within(0.0, 2.0).doc("smaller numbers fail");
        s.param("does", &Params::does)
            .choices({"nothing", "throws", "aborts", "exits", "is_killed"})
            .doc("with numbers that fail");
    }
    explicit Result(Params params) : params_(std::move(params)) {}
    void finish(petal::Run& run) override {
        const double value = run.all<Value>("value").front()->value;
        std::this_thread::sleep_for(std::chrono::milliseconds(params_.pause_ms));
        if (value < params_.below) fail();
        run.output("result.json", [&](const std::filesystem::path& path) {
            petal::write_file(
                path,
                "{\"metrics\": {\"value\": " + petal::printed("%.9g", params_.factor * value) +
                    "}, \"twice\": [" + petal::printed("%.9g", 2.0 * value) + "]}\n");
        });
    }

   private:
    void fail() const {
        if (params_.does == "throws") throw petal::Error("a number that is too small");
        if (params_.does == "aborts") std::abort();
        if (params_.does == "exits") std::_Exit(0);
        if (params_.does == "is_killed") std::raise(SIGKILL);
    }
    Params params_;
};

}  // namespace
}  // namespace unsure

PETAL_PLUGIN("unsure", "0.1.0", [](petal::Registrar& r) {
    r.add<unsure::Draw>("unsure.draw");
    r.add<unsure::Result>("unsure.result");
});
