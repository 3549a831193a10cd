// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

// A whole `petal run` of the streaming pipeline against a bare MRPT copy loop over the same rawlog,
// with the same compression. Both in turns, the fastest of each counts: `speed` is the bare loop's
// time over petal's, so 1 is equal and more is faster.

#include <benchmark/benchmark.h>
#include <mrpt/io/CFileGZInputStream.h>
#include <mrpt/io/CFileGZOutputStream.h>
#include <mrpt/maps/CPointsMapXYZI.h>
#include <mrpt/obs/CObservationIMU.h>
#include <mrpt/obs/CObservationImage.h>
#include <mrpt/obs/CObservationPointCloud.h>
#include <mrpt/serialization/CArchive.h>
#include <stdlib.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <limits>
#include <random>
#include <string>

namespace petal {
namespace {

namespace fs = std::filesystem;
using namespace mrpt::obs;

constexpr int kRounds = 150;  // of 1 cloud, 1 image, 10 IMU readings: 0.7 MB each

/// A wall with noise, as a LiDAR sees it: coordinates that compress as real ones do.
CObservation::Ptr cloud(std::mt19937& rng, mrpt::Clock::time_point stamp) {
    std::normal_distribution<float> noise(0.0F, 0.02F);
    auto points = mrpt::maps::CPointsMapXYZI::Create();
    constexpr int kPoints = 24000;
    points->reserve(kPoints);
    for (int i = 0; i < kPoints; ++i) {
        const float angle = static_cast<float>(i) * 0.0021F;
        const float range = 5.0F + noise(rng) + (i % 40 == 0 ? 300.0F : 0.0F);
        points->insertPointFast(range * std::cos(angle), range * std::sin(angle), noise(rng));
        points->setPointIntensity(points->size() - 1, static_cast<float>(rng() % 256) / 255.0F);
    }
    auto observation = CObservationPointCloud::Create();
    observation->sensorLabel = "LIDAR";
    observation->timestamp = stamp;
    observation->pointcloud = points;
    return observation;
}

/// A gradient with noise in the last bits.
CObservation::Ptr image(std::mt19937& rng, mrpt::Clock::time_point stamp) {
    auto observation = CObservationImage::Create();
    observation->sensorLabel = "CAMERA";
    observation->timestamp = stamp;
    observation->image.resize(640, 480, mrpt::img::CH_GRAY);
    for (int row = 0; row < 480; ++row) {
        auto* line = observation->image.ptrLine<std::uint8_t>(static_cast<unsigned>(row));
        for (int column = 0; column < 640; ++column)
            line[column] =
                static_cast<std::uint8_t>((row + column) / 5 + static_cast<int>(rng() % 4));
    }
    return observation;
}

void make_rawlog(const fs::path& file, int level) {
    std::mt19937 rng(1);
    mrpt::io::CFileGZOutputStream stream;
    stream.open(file.string(), level);
    auto archive = mrpt::serialization::archiveFrom(stream);
    auto stamp = mrpt::Clock::fromDouble(1.7e9);
    const auto step = std::chrono::milliseconds(10);
    for (int round = 0; round < kRounds; ++round) {
        archive << *cloud(rng, stamp) << *image(rng, stamp);
        for (int i = 0; i < 10; ++i) {
            CObservationIMU imu;
            imu.sensorLabel = "IMU";
            imu.timestamp = stamp += step;
            imu.set(IMU_X_ACC, 0.1 * i);
            archive << imu;
        }
    }
}

void copy_bare(const fs::path& from, const fs::path& to, int level) {
    mrpt::io::CFileGZInputStream input(from.string());
    mrpt::io::CFileGZOutputStream output;
    output.open(to.string(), level);
    auto in = mrpt::serialization::archiveFrom(input);
    auto out = mrpt::serialization::archiveFrom(output);
    try {
        while (true) out << *in.ReadObject();
    } catch (const mrpt::serialization::CExceptionEOF&) {
    }
}

template <class Action>
double seconds(const Action& action) {
    const auto start = std::chrono::steady_clock::now();
    action();
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// `level` is the compression of what is read and written; `filter` 0 lets all points through.
void rawlog_copy(benchmark::State& state) {
    const int level = static_cast<int>(state.range(0));
    const bool filter = state.range(2) != 0;
    std::string name = (fs::temp_directory_path() / "petal-benchmark-XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr) return state.SkipWithError("no temporary folder");
    const fs::path folder = name;
    const fs::path log = folder / "scene.rawlog";
    make_rawlog(log, level);
    const std::string command =
        PETAL_BUILD_DIR "/bin/petal --quiet run " PETAL_SOURCE_DIR
                        "/pipelines/filter_rawlog.json --force --data '" +
        folder.string() + "' --out '" + (fs::path(name + "-run")).string() + "' --threads " +
        std::to_string(state.range(1)) + " --set out.compression=" + std::to_string(level) +
        (filter ? "" : " --set filter.min_range=0.0 --set filter.max_range=1000000.0") +
        " >/dev/null";
    double bare = std::numeric_limits<double>::infinity();
    double petal = bare;
    bool failed = false;
    for (auto _ : state) {
        bare = std::min(bare, seconds([&] { copy_bare(log, folder / "bare.rawlog", level); }));
        const double took = seconds([&] { failed = failed || std::system(command.c_str()) != 0; });
        petal = std::min(petal, took);
        state.SetIterationTime(took);
    }
    if (failed) state.SkipWithError("petal run failed");
    state.counters["bare_s"] = bare;
    state.counters["petal_s"] = petal;
    state.counters["speed"] = bare / petal;
    fs::remove_all(folder);
    fs::remove_all(name + "-run");
}
BENCHMARK(rawlog_copy)
    ->ArgNames({"level", "threads", "filter"})
    ->Args({0, 1, 0})
    ->Args({0, 2, 0})
    ->Args({0, 2, 1})
    ->Args({1, 1, 0})
    ->Args({1, 2, 0})
    ->Args({1, 2, 1})
    ->Iterations(5)
    ->UseManualTime()
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace petal
