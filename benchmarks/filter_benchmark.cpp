// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

// Time per point of filters over clouds of 1 to 16 M points: build/bin/petal_filter_benchmark. The
// column CPU is that of all threads, so that a busy machine tells something too.
// Beside filter.margin_points stands filter.none, which is what handing a cloud on costs.

#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>
#include <random>

#include "filters/margin_points.hpp"
#include "filters/none.hpp"
#include "filters/sparse_points.hpp"
#include "petal/calibration/cloud.hpp"
#include "petal/testing/stage_harness.hpp"

namespace petal {
namespace {

constexpr double kDegree = M_PI / 180.0;

/// To the nearest of a board with four holes at 3 m, a wall at 3.3 m, a floor and two side walls.
double range_in_room(double x, double y, double z) {
    double range = std::min(3.3 / x, 2.8 / std::abs(y));
    if (z < 0.0) range = std::min(range, 0.45 / -z);
    const double across = 3.0 * y / x + 0.25, down = 0.25 - 3.0 * z / x;
    const auto in_hole = [](double at) { return (at > 0.1 && at < 0.2) || (at > 0.3 && at < 0.4); };
    const bool on_board = across > 0.0 && across < 0.5 && down > 0.0 && down < 0.5;
    if (on_board && !(in_hole(across) && in_hole(down))) range = std::min(range, 3.0 / x);
    return range;
}

/// Two prisms' rosette over a cone of 70 deg, with 12 mm of noise: the order of points, and their
/// crowding in the middle, are those of a real one.
Cloud rosette(std::size_t count) {
    std::mt19937_64 engine(1);
    auto points = std::make_shared<mrpt::maps::CPointsMapXYZI>();
    points->resize(count);
    for (std::size_t i = 0; i < count; ++i) {
        // The longer the capture, the denser: 100,000 points a second.
        const double t = static_cast<double>(i) * 1e-5;
        const double first = 2.0 * M_PI * 121.5683 * t, second = -2.0 * M_PI * 77.7383 * t;
        const double y = std::tan(17.6 * kDegree) * (std::cos(first) + std::cos(second));
        const double z = std::tan(17.6 * kDegree) * (std::sin(first) + std::sin(second));
        const double length = std::sqrt(1.0 + y * y + z * z);
        double noise = -6.0;  // a sum of twelve: nearly normal, of variance one
        for (int k = 0; k < 12; ++k) noise += static_cast<double>(engine() >> 40U) * 0x1.0p-24;
        const double range = range_in_room(1.0 / length, y / length, z / length) + 0.012 * noise;
        points->setPointFast(i, static_cast<float>(range / length),
                             static_cast<float>(range * y / length),
                             static_cast<float>(range * z / length));
    }
    points->mark_as_modified();
    Cloud cloud;
    cloud.points = std::move(points);
    return cloud;
}

template <class Filter>
void filtered(benchmark::State& state) {
    auto stage = testing::StageHarness::of<Filter>();
    const auto count = static_cast<std::size_t>(state.range(0)) * 1000000U;
    stage.threads(static_cast<int>(state.range(1)));
    stage.template give<Cloud>("cloud", rosette(count));
    for (auto _ : state) stage.fire();
    const double points = static_cast<double>(count);
    state.counters["points"] =
        benchmark::Counter(points, benchmark::Counter::kIsIterationInvariantRate);
    state.counters["point"] = benchmark::Counter(
        points, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}
BENCHMARK(filtered<NoFilter>)
    ->ArgNames({"million", "threads"})
    ->Args({1, 2})
    ->Args({16, 2})
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime()
    ->UseRealTime();
BENCHMARK(filtered<MarginPoints>)
    ->ArgNames({"million", "threads"})
    ->ArgsProduct({{1, 2, 4, 8, 16}, {1, 2}})
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime()
    ->UseRealTime();
BENCHMARK(filtered<SparsePoints>)
    ->ArgNames({"million", "threads"})
    ->Args({1, 2})
    ->Args({4, 2})
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime()
    ->UseRealTime();

}  // namespace
}  // namespace petal
