// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "filters/statistical_outlier.hpp"

#include <cmath>
#include <cstdint>
#include <memory>
#include <nanoflann.hpp>
#include <vector>

#include "filters/detail/write_subset.hpp"
#include "petal/calibration/for_pieces.hpp"
#include "petal/printed.hpp"

namespace petal {
namespace {

using mrpt::maps::CPointsMapXYZI;
/// The map itself is what nanoflann reads.
using MapTree =
    nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<float, CPointsMapXYZI, double>,
                                        CPointsMapXYZI, 3, std::uint32_t>;

constexpr std::size_t kQueries = 4096;  // a piece of work

/// The mean distance (m) of each point to so many nearest others, or to all where there are fewer;
/// there is another.
std::vector<double> distances_to_nearest(const CPointsMapXYZI& points, int neighbours, Run& run) {
    const MapTree tree(3, points);
    const auto asked = static_cast<std::size_t>(neighbours) + 1;  // a point finds itself too
    std::vector<double> means(points.size());
    for_pieces(run, points.size(), kQueries, [&](std::size_t begin, std::size_t end) {
        std::vector<std::uint32_t> found(asked);
        std::vector<double> squares(asked);
        for (std::size_t k = begin; k < end; ++k) {
            const std::uint32_t i = tree.vAcc[k];  // leaf by leaf, so that memory is near
            float place[3];
            points.getPointFast(i, place[0], place[1], place[2]);
            const std::size_t count = tree.knnSearch(place, asked, found.data(), squares.data());
            double sum = 0.0;
            for (std::size_t n = 0; n < count; ++n) sum += std::sqrt(squares[n]);
            means[i] = sum / static_cast<double>(count - 1);
        }
    });
    return means;
}

double deviation_limit(const std::vector<double>& values, double deviations) {
    const auto count = static_cast<double>(values.size());
    double sum = 0.0, squares = 0.0;
    for (const double value : values) sum += value;
    const double mean = sum / count;
    for (const double value : values) squares += (value - mean) * (value - mean);
    constexpr double kRounding = 1.0 + 1e-9;  // where all are equal, all stay
    return (mean + deviations * std::sqrt(squares / count)) * kRounding;
}

}  // namespace

void StatisticalOutlier::describe(Spec<Params>& s) {
    s.summary("Drops points whose mean distance to their neighbours is unusually large.");
    s.doc(
        R"(Takes for each point the mean distance to its `neighbours` nearest others, and over the whole cloud the mean
and the standard deviation of these; a point goes where its own lies more than `max_deviations` of them above the mean
(Rusu et al., *Towards 3D point cloud based object maps for household environments*, 2008, section 4.1).

One limit holds for the whole cloud, while the points of a LiDAR thin out with the square of the range: what is far goes first, a background
50 m away before a lonely point in front of a board. Where a neighbour's distance is unusual depends on the scene too: the
larger it is, the more stays near the sensor.

A search tree is built over all points: the slowest of the filters.)");
    s.role("outlier_remover");
    s.reads<Cloud>("cloud", "points in the LiDAR frame");
    s.writes<Cloud>("cloud", "the points that stay, in their order");
    s.param("neighbours", &Params::neighbours)
        .within(1, 200)
        .doc("nearest others that a point is judged by");
    s.param("max_deviations", &Params::max_deviations)
        .unit("1")
        .within(0.0, 100.0)
        .doc("standard deviations above the mean at which a point still stays");
}

void StatisticalOutlier::run(Run& run) {
    const auto& cloud = run.in<Cloud>("cloud");
    const auto finite = finite_points(cloud);
    std::vector<std::uint32_t> kept;
    if (finite.size() > 1) {
        // The tree takes a map without NaN.
        const auto points =
            finite.size() == cloud.size() ? cloud.points : subset(cloud, finite).points;
        const auto distances = distances_to_nearest(*points, params_.neighbours, run);
        const double limit = deviation_limit(distances, params_.max_deviations);
        for (std::size_t k = 0; k < finite.size(); ++k)
            if (distances[k] <= limit) kept.push_back(finite[k]);
    }
    write_subset(
        run, cloud, kept, finite.size(),
        {"points with neighbours", "",
         printed("neighbours %d, max_deviations %g", params_.neighbours, params_.max_deviations),
         "give more seconds of data, or raise max_deviations"});
}

}  // namespace petal
