// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "statistical_outlier.hpp"

#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <nanoflann.hpp>
#include <string>
#include <utility>
#include <vector>

#include "petal/calibration/cloud.hpp"

namespace example {
namespace {

using mrpt::maps::CPointsMapXYZI;
using petal::Cloud;

/// The finite points of a map, as nanoflann reads them: no coordinate is copied.
struct FinitePoints {
    explicit FinitePoints(const CPointsMapXYZI& points) : map(points) {
        const auto &xs = map.getPointsBufferRef_x(), &ys = map.getPointsBufferRef_y(),
                   &zs = map.getPointsBufferRef_z();
        for (std::size_t i = 0; i < map.size(); ++i)
            if (std::isfinite(xs[i]) && std::isfinite(ys[i]) && std::isfinite(zs[i]))
                index.push_back(static_cast<std::uint32_t>(i));
    }

    std::size_t kdtree_get_point_count() const { return index.size(); }
    float kdtree_get_pt(std::size_t i, std::size_t axis) const {
        const auto& buffer = axis == 0   ? map.getPointsBufferRef_x()
                             : axis == 1 ? map.getPointsBufferRef_y()
                                         : map.getPointsBufferRef_z();
        return buffer[index[i]];
    }
    template <class Box>
    bool kdtree_get_bbox(Box&) const {
        return false;  // nanoflann computes it
    }

    const CPointsMapXYZI& map;
    std::vector<std::uint32_t> index;  ///< of each finite point in the map
};

using Tree =
    nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<float, FinitePoints, double>,
                                        FinitePoints, 3, std::uint32_t>;

/// For each finite point the mean distance (m) to its nearest neighbours; infinite where it has
/// none.
std::vector<double> mean_distances(const FinitePoints& points, int neighbours,
                                   const petal::Run& run) {
    const Tree tree(3, points);
    const auto asked = static_cast<std::size_t>(neighbours) + 1;  // the point finds itself too
    std::vector<std::uint32_t> found(asked);
    std::vector<double> squares(asked);
    std::vector<double> means;
    means.reserve(points.index.size());
    for (std::size_t i = 0; i < points.index.size(); ++i) {
        if (i % 4096 == 0) run.check_cancelled();
        const float point[3] = {points.kdtree_get_pt(i, 0), points.kdtree_get_pt(i, 1),
                                points.kdtree_get_pt(i, 2)};
        const std::size_t count = tree.knnSearch(point, asked, found.data(), squares.data());
        double sum = 0.0;
        for (std::size_t k = 0; k < count; ++k) sum += std::sqrt(squares[k]);
        means.push_back(count > 1 ? sum / static_cast<double>(count - 1)
                                  : std::numeric_limits<double>::infinity());
    }
    return means;
}

/// The largest mean distance that is still ordinary: mean + `deviations` standard deviations.
double largest_kept(const std::vector<double>& distances, double deviations) {
    double sum = 0.0, squares = 0.0;
    std::size_t count = 0;
    for (const double d : distances)
        if (std::isfinite(d)) sum += d, squares += d * d, ++count;
    if (count == 0) return 0.0;
    const double mean = sum / static_cast<double>(count);
    const double variance = squares / static_cast<double>(count) - mean * mean;
    return mean + deviations * std::sqrt(variance > 0.0 ? variance : 0.0);
}

}  // namespace

void StatisticalOutlier::describe(petal::Spec<Params>& spec) {
    spec.summary("Drops points whose mean distance to their neighbours is unusually large.");
    spec.doc(
        R"(For each point the mean distance to its `neighbours` nearest neighbours is taken; a point
goes when that is more than `max_deviations` standard deviations above the mean over the cloud
(Rusu et al., *Towards 3D point cloud based object maps for household environments*, 2008,
section 4.1). Points that are not finite go too.)");
    spec.role("outlier_remover");
    spec.reads<Cloud>("cloud", "points in the LiDAR frame");
    spec.writes<Cloud>("cloud", "the points that stay, in their order");
    spec.param("neighbours", &Params::neighbours)
        .within(1, 1000)
        .doc("nearest neighbours that a point is judged by");
    spec.param("max_deviations", &Params::max_deviations)
        .unit("1")
        .within(0.0, 100.0)
        .doc("standard deviations above the mean that a point may lie");
}

void StatisticalOutlier::run(petal::Run& run) {
    const auto& in = run.in<Cloud>("cloud");
    const FinitePoints points(*in.points);
    const auto distances = mean_distances(points, params_.neighbours, run);
    const double limit = largest_kept(distances, params_.max_deviations);

    Cloud out;
    out.sensor_label = in.sensor_label;
    out.sensor_pose = in.sensor_pose;
    auto kept = std::make_shared<CPointsMapXYZI>();
    kept->reserve(points.index.size());
    for (std::size_t i = 0; i < points.index.size(); ++i) {
        if (!(distances[i] <= limit)) continue;
        const std::uint32_t from = points.index[i];
        kept->insertPointFast(in.points->getPointsBufferRef_x()[from],
                              in.points->getPointsBufferRef_y()[from],
                              in.points->getPointsBufferRef_z()[from]);
        kept->setPointIntensity(kept->size() - 1, in.points->getPointIntensity(from));
        out.scene_index.push_back(in.scene_index.empty() ? from : in.scene_index[from]);
    }
    kept->mark_as_modified();
    if (kept->empty())
        run.note({"points with neighbours", std::to_string(points.index.size()) + " finite points",
                  "neighbours " + std::to_string(params_.neighbours), "wire a denser cloud"});
    run.log(petal::LogLevel::info, "kept " + std::to_string(kept->size()) + " of " +
                                       std::to_string(in.size()) + " points");
    out.points = std::move(kept);
    run.write("cloud", std::move(out));
}

}  // namespace example
