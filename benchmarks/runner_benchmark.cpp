// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include <benchmark/benchmark.h>
#include <stdlib.h>

#include <filesystem>
#include <string>

#include "petal/output.hpp"
#include "registry.hpp"
#include "runner.hpp"
#include "runner_fakes.hpp"

namespace petal {
namespace {

namespace fs = std::filesystem;

constexpr int kFrames = 20000;

/// A source and a chain of stages that do next to nothing: what is left is the framework.
std::string chain(int stages) {
    std::string text =
        R"({"petal": 1, "stages": {"s0": {"type": "fake.count", "params": {"frames": )" +
        std::to_string(kFrames) + "}}";
    for (int i = 1; i <= stages; ++i)
        text += ", \"s" + std::to_string(i) + R"(": {"type": "fake.affine", "in": {"number": "s)" +
                std::to_string(i - 1) + R"(.number"}})";
    return text + "}}";
}

/// Seconds of one packet over one hop: firing the stage included, and the source's share. A chain
/// of one stage so pays two firings for its one hop.
void packet_and_hop(benchmark::State& state) {
    std::string name = (fs::temp_directory_path() / "petal-benchmark-XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr) return state.SkipWithError("no temporary folder");
    const fs::path folder = name;
    Registry registry;
    registry.add(describe_stage<runner_fakes::Count>("fake.count"));
    registry.add(describe_stage<runner_fakes::Affine>("fake.affine"));
    const int stages = static_cast<int>(state.range(0));
    write_file(folder / "chain.json", chain(stages));
    PipelineRequest request;
    request.file = folder / "chain.json";
    const CheckedPipeline read = read_pipeline(request, registry);
    RunSettings settings;
    settings.threads = static_cast<int>(state.range(1));
    settings.folder = folder;
    RunLog log(folder, Verbosity::quiet);  // one: closing it waits for the disk
    for (auto _ : state) benchmark::DoNotOptimize(run_pipeline(*read.pipeline, settings, log));
    const double hops = static_cast<double>(kFrames) * stages;
    state.counters["hop"] = benchmark::Counter(
        hops, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
    fs::remove_all(folder);
}
BENCHMARK(packet_and_hop)
    ->ArgNames({"stages", "threads"})
    ->Args({1, 1})
    ->Args({8, 1})
    ->Args({8, 2})
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace petal
