// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include <gmock/gmock.h>
#include <stdlib.h>
#include <tbb/parallel_for.h>

#include <atomic>
#include <chrono>
#include <filesystem>
#include <thread>

#include "petal/output.hpp"
#include "registry.hpp"
#include "runner.hpp"
#include "runner_fakes.hpp"

namespace petal {
namespace {

namespace fs = std::filesystem;
using runner_fakes::None;
using runner_fakes::Number;

/// True as soon as it holds; false after 20 s, far more than the threads need.
template <class Holds>
bool comes_true(Holds holds) {
    for (int i = 0; i < 20000 && !holds(); ++i)
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    return holds();
}

std::atomic<int> arrived{0};

/// In frame 0 waits until a second one is at work too.
class Meet final : public Stage {
   public:
    using Params = None;
    static void describe(Spec<Params>& s) {
        s.summary("Meets another.");
        s.reads<Number>("number", "in");
        s.writes<Number>("number", "out");
    }
    explicit Meet(Params) {}
    void run(Run& run) override {
        if (run.frame().number == 0) {
            ++arrived;
            if (!comes_true([] { return arrived >= 2; })) throw Error("nobody came");
        }
        run.write("number", run.in<Number>("number"));
    }
};

/// Many small tasks of its own inside one firing; fails when the runner puts another stage between.
class Inner final : public Stage {
   public:
    using Params = None;
    static void describe(Spec<Params>& s) {
        s.summary("Uses tasks.");
        s.reads<Number>("number", "in");
        s.writes<Number>("number", "out");
    }
    explicit Inner(Params) {}
    void run(Run& run) override {
        thread_local int depth = 0;
        if (depth > 0) throw Error("another firing inside a firing");
        ++depth;
        std::atomic<std::int64_t> sum{0};
        tbb::parallel_for(0, 200, [&sum](int i) {
            std::this_thread::sleep_for(std::chrono::microseconds(20));
            sum += i;
        });
        --depth;
        run.write("number", Number{sum + run.in<Number>("number").value});
    }
};

class RunnerParallelTest : public ::testing::Test {
   protected:
    void SetUp() override {
        std::string name = (fs::temp_directory_path() / "petal-parallel-XXXXXX").string();
        ASSERT_NE(mkdtemp(name.data()), nullptr);
        folder_ = name;
        registry_.add(describe_stage<runner_fakes::Count>("fake.count"));
        registry_.add(describe_stage<runner_fakes::Sum>("fake.sum"));
        registry_.add(describe_stage<Meet>("fake.meet"));
        registry_.add(describe_stage<Inner>("fake.inner"));
    }
    void TearDown() override { fs::remove_all(folder_); }

    RunReport run(const std::string& stages, int threads) {
        write_file(folder_ / "p.json", R"({"petal": 1, "stages": {)" + stages + "}}");
        PipelineRequest request;
        request.file = folder_ / "p.json";
        const CheckedPipeline read = read_pipeline(request, registry_);
        for (const Problem& problem : read.problems) ADD_FAILURE() << to_string(problem);
        RunSettings settings;
        settings.threads = threads;
        settings.folder = folder_ / "out";
        RunLog log(settings.folder, Verbosity::quiet);
        return run_pipeline(*read.pipeline, settings, log);
    }

    fs::path folder_;
    Registry registry_;
};

TEST_F(RunnerParallelTest, BranchesFireAtTheSameTime) {
    arrived = 0;
    const RunReport report = run(R"("a": {"type": "fake.count", "params": {"frames": 3}},
        "b": {"type": "fake.meet", "in": {"number": "a.number"}},
        "c": {"type": "fake.meet", "in": {"number": "a.number"}},
        "s": {"type": "fake.sum", "in": {"a": "b.number", "b": "c.number"}})",
                                 2);
    EXPECT_THAT(report.errors, ::testing::IsEmpty());
    EXPECT_EQ(report.stages.at("s").packets, 3U);
}

TEST_F(RunnerParallelTest, AStageThatWaitsForItsOwnTasksIsLeftAlone) {
    const RunReport report = run(R"("a": {"type": "fake.count", "params": {"frames": 20}},
        "b": {"type": "fake.inner", "in": {"number": "a.number"}},
        "c": {"type": "fake.inner", "in": {"number": "a.number"}},
        "d": {"type": "fake.inner", "in": {"number": "a.number"}})",
                                 4);
    EXPECT_THAT(report.errors, ::testing::IsEmpty());
    EXPECT_EQ(report.stages.at("d").packets, 20U);
}

TEST_F(RunnerParallelTest, TimesOfStagesAreToldAndCpuTimeIsNoLongerThanWallTime) {
    const RunReport report = run(R"("a": {"type": "fake.count", "params": {"frames": 20000}},
        "b": {"type": "fake.meet", "in": {"number": "c.number"}},
        "c": {"type": "fake.inner", "in": {"number": "d.number"}},
        "d": {"type": "fake.count", "params": {"frames": 2}})",
                                 (arrived = 1, 2));
    EXPECT_THAT(report.errors, ::testing::IsEmpty());
    for (const auto& [id, s] : report.stages) {
        EXPECT_GT(s.wall_s, 0.0) << id;
        EXPECT_GE(s.cpu_s, 0.0) << id;
        EXPECT_LE(s.cpu_s, s.wall_s * 1.001) << id;  // both are sums of roundings
    }
    EXPECT_GT(report.stages.at("a").cpu_s, 0.0);
    // 400 tasks of 20 us on at most 2 threads.
    EXPECT_GE(report.stages.at("c").wall_s, 400 * 20e-6 / 2);
}

}  // namespace
}  // namespace petal
