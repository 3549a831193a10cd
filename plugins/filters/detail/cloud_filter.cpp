// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "filters/detail/cloud_filter.hpp"

#include <mrpt/obs/CObservationPointCloud.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "petal/rawlog/lidar_points.hpp"
#include "petal/rawlog/sensor_label.hpp"

namespace petal {
namespace {

using mrpt::maps::CPointsMap;
using mrpt::obs::CObservationPointCloud;

/// Marks the points with a coordinate that is not finite. How many there are.
std::size_t mark_not_finite(const CPointsMap& points, std::vector<bool>& drop) {
    const auto& xs = points.getPointsBufferRef_x();
    const auto& ys = points.getPointsBufferRef_y();
    const auto& zs = points.getPointsBufferRef_z();
    std::size_t count = 0;
    for (std::size_t i = 0; i < drop.size(); ++i) {
        drop[i] = !(std::isfinite(xs[i]) && std::isfinite(ys[i]) && std::isfinite(zs[i]));
        if (drop[i]) ++count;
    }
    return count;
}

/// A copy of the observation whose map, of the same class, lacks the marked points.
mrpt::obs::CObservation::Ptr without(const CObservationPointCloud& cloud,
                                     const std::vector<bool>& drop) {
    const auto copy = CObservationPointCloud::Create(cloud);  // shares the points
    const CPointsMap& from = *cloud.pointcloud;
    copy->pointcloud = std::dynamic_pointer_cast<CPointsMap>(from.duplicateGetSmartPtr());
    copy->pointcloud->applyDeletionMask(drop);
    // MRPT 2.5 duplicates the points only; the options are stored with the map too.
    copy->pointcloud->insertionOptions = from.insertionOptions;
    copy->pointcloud->likelihoodOptions = from.likelihoodOptions;
    copy->pointcloud->renderOptions = from.renderOptions;
    copy->pointcloud->genericMapParams = from.genericMapParams;
    copy->overrideExternalStorageFormatFlag(CObservationPointCloud::ExternalStorageFormat::None);
    return copy;
}

}  // namespace

bool CloudFilter::passes(const mrpt::obs::CObservation& observation) {
    const auto* cloud = dynamic_cast<const CObservationPointCloud*>(&observation);
    const bool chosen = labels_.empty() || label_fits_any(labels_, observation.sensorLabel);
    if (cloud != nullptr && cloud->pointcloud && chosen) return false;
    ++passed_;
    if (cloud == nullptr && chosen && is_lidar(observation))
        ++other_forms_["'" + observation.sensorLabel + "' (" +
                       observation.GetRuntimeClass()->className + ")"];
    return true;
}

void CloudFilter::run(Run& run) {
    auto packet = run.in_ptr<Observation>("observation");
    if (passes(*packet->observation)) return run.forward("observation", std::move(packet));
    const auto& cloud = static_cast<const CObservationPointCloud&>(*packet->observation);
    const CPointsMap& points = *cloud.pointcloud;
    drop_.assign(points.size(), false);
    not_finite_ += mark_not_finite(points, drop_);
    mark(points, drop_);
    const auto kept = static_cast<std::size_t>(std::count(drop_.begin(), drop_.end(), false));
    ++clouds_;
    points_ += drop_.size();
    kept_ += kept;
    if (kept == drop_.size()) return run.forward("observation", std::move(packet));
    run.write("observation", Observation{without(cloud, drop_), packet->place});
}

void CloudFilter::finish(Run& run) {
    run.log(LogLevel::info, std::to_string(kept_) + " of " + std::to_string(points_) +
                                " points stay (" + std::to_string(not_finite_) +
                                " were not finite), in " + std::to_string(clouds_) + " clouds; " +
                                std::to_string(passed_) + " other observations passed");
    for (const auto& [sensor, count] : other_forms_)
        run.note({"point clouds",
                  std::to_string(count) + " observations of " + sensor +
                      " hold their points in another form and went through as they are",
                  "", "only CObservationPointCloud is filtered"});
    if (clouds_ == 0 && other_forms_.empty())
        run.note({"point clouds", "none among " + std::to_string(passed_) + " observations", "",
                  labels_.empty() ? "" : "check labels"});
    if (points_ > 0 && kept_ == 0)
        run.note(
            {"points that stay",
             "none of " + std::to_string(points_) + " in " + std::to_string(clouds_) + " clouds",
             "", "widen the filter"});
}

}  // namespace petal
