// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

// A whole `petal run pipelines/letter.json` against a program that only reads the same rawlog with
// MRPT and gathers its points (this one, as `petal_letter_benchmark --bare RAWLOG`). The rawlog is
// the simulator's: 2 M points in 20 s, compressed. Both in turns, the fastest of each counts.
// Memory is the peak of the run above that of `petal check` of the same pipeline, in units of the
// scene's points (16 bytes each).

#include <benchmark/benchmark.h>
#include <mrpt/io/CFileGZInputStream.h>
#include <mrpt/maps/CPointsMapXYZI.h>
#include <mrpt/obs/CObservationPointCloud.h>
#include <mrpt/serialization/CArchive.h>
#include <stdlib.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <limits>
#include <string>

namespace petal {
namespace {

namespace fs = std::filesystem;

/// Reads a rawlog of observations as MRPT's own examples do. Gives the number of points.
std::size_t read_bare(const fs::path& file) {
    mrpt::io::CFileGZInputStream input(file.string());
    auto archive = mrpt::serialization::archiveFrom(input);
    mrpt::maps::CPointsMapXYZI points;
    try {
        while (true) {
            const auto cloud =
                std::dynamic_pointer_cast<mrpt::obs::CObservationPointCloud>(archive.ReadObject());
            if (!cloud) continue;
            const auto& map = dynamic_cast<mrpt::maps::CPointsMapXYZI&>(*cloud->pointcloud);
            // Neither insertAnotherMap() nor reserve(): both copy all points at each message.
            const std::size_t begin = points.size();
            points.resize(begin + map.size());
            for (std::size_t i = 0; i < map.size(); ++i) {
                points.setPointFast(begin + i, map.getPointsBufferRef_x()[i],
                                    map.getPointsBufferRef_y()[i], map.getPointsBufferRef_z()[i]);
                points.setPointColor_fast(begin + i, map.getPointsBufferRef_intensity()[i], 0.0F,
                                          0.0F);
            }
        }
    } catch (const mrpt::serialization::CExceptionEOF&) {
    }
    return points.size();
}

struct Use {
    double seconds = std::numeric_limits<double>::infinity();  ///< by the clock
    double cpu = std::numeric_limits<double>::infinity();      ///< s, of all threads
    double peak = -1.0;                                        ///< bytes of memory; -1: it failed
};

/// Runs the command.
Use use_of(const std::string& command) {
    const auto start = std::chrono::steady_clock::now();
    const pid_t child = fork();
    if (child == 0) {
        execl("/bin/sh", "sh", "-c", ("exec " + command + " >/dev/null").c_str(), nullptr);
        _exit(127);
    }
    int status = 0;
    rusage usage = {};
    if (child < 0 || wait4(child, &status, 0, &usage) != child || !WIFEXITED(status)) return {};
    // 4: done, with a verdict that one board does not make a calibration.
    if (WEXITSTATUS(status) != 0 && WEXITSTATUS(status) != 4) return {};
    const auto seconds = [](const timeval& time) {
        return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
    };
    return {std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(),
            seconds(usage.ru_utime) + seconds(usage.ru_stime),
            1024.0 * static_cast<double>(usage.ru_maxrss)};
}

void letter_run(benchmark::State& state) {
    std::string name = (fs::temp_directory_path() / "petal-benchmark-XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr) return state.SkipWithError("no temporary folder");
    const fs::path folder = name;
    const std::string program = PETAL_BUILD_DIR "/bin/petal --quiet ";
    const std::string pipelines = PETAL_SOURCE_DIR "/pipelines/";
    const std::string data = (folder / "data").string();
    const std::string letter = program + "run " + pipelines + "letter.json --force --data '" +
                               data + "' --out '" + (folder / "run").string() + "' --threads " +
                               std::to_string(state.range(0));
    const Use idle = use_of(program + "check " + pipelines + "letter.json --data '" + data + "'");
    const Use made = use_of(program + "run " + pipelines + "simulate.json --out '" + data +
                            "' --seed 3 --set scene.duration=20.0");
    if (idle.peak < 0.0 || made.peak < 0.0)
        return state.SkipWithError("petal check or petal run simulate.json failed");
    Use bare, petal;
    const auto keep_least = [&state](Use& least, const Use& use) {
        if (use.peak < 0.0) state.SkipWithError("a program failed");
        least.seconds = std::min(least.seconds, use.seconds);
        least.cpu = std::min(least.cpu, use.cpu);
        least.peak = std::max(least.peak, use.peak);
    };
    const fs::path rawlog = folder / "data" / "scene.rawlog";
    const std::string bare_program =
        fs::read_symlink("/proc/self/exe").string() + " --bare '" + rawlog.string() + "'";
    const std::size_t points = read_bare(rawlog);
    for (auto _ : state) {
        keep_least(bare, use_of(bare_program));
        const Use use = use_of(letter);
        keep_least(petal, use);
        state.SetIterationTime(use.seconds);
    }
    state.counters["points"] = static_cast<double>(points);
    state.counters["bare_s"] = bare.seconds;
    state.counters["petal_s"] = petal.seconds;
    state.counters["more_s"] = petal.seconds - bare.seconds;
    state.counters["bare_cpu"] = bare.cpu;
    state.counters["petal_cpu"] = petal.cpu;
    state.counters["memory"] = (petal.peak - idle.peak) / (16.0 * static_cast<double>(points));
    fs::remove_all(folder);
}
BENCHMARK(letter_run)
    ->ArgName("threads")
    ->Arg(1)
    ->Arg(2)
    ->Iterations(7)
    ->UseManualTime()
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace petal

int main(int count, char** arguments) {
    if (count == 3 && std::string(arguments[1]) == "--bare") {
        std::printf("%zu points\n", petal::read_bare(arguments[2]));
        return 0;
    }
    benchmark::Initialize(&count, arguments);
    benchmark::RunSpecifiedBenchmarks();
    return 0;
}
