// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "petal/calibration/cloud_subset.hpp"

#include <cmath>
#include <memory>
#include <utility>

namespace petal {

bool is_finite(const Cloud& cloud, std::size_t i) {
    return std::isfinite(cloud.points->getPointsBufferRef_x()[i]) &&
           std::isfinite(cloud.points->getPointsBufferRef_y()[i]) &&
           std::isfinite(cloud.points->getPointsBufferRef_z()[i]);
}

std::vector<std::uint32_t> finite_points(const Cloud& cloud) {
    std::vector<std::uint32_t> indices;
    indices.reserve(cloud.size());
    for (std::size_t i = 0; i < cloud.size(); ++i)
        if (is_finite(cloud, i)) indices.push_back(static_cast<std::uint32_t>(i));
    return indices;
}

Cloud subset(const Cloud& cloud, const std::vector<std::uint32_t>& indices) {
    Cloud out;
    out.sensor_label = cloud.sensor_label;
    out.sensor_pose = cloud.sensor_pose;
    const auto& xs = cloud.points->getPointsBufferRef_x();
    const auto& ys = cloud.points->getPointsBufferRef_y();
    const auto& zs = cloud.points->getPointsBufferRef_z();
    const auto& intensities = cloud.points->getPointsBufferRef_intensity();
    auto points = std::make_shared<mrpt::maps::CPointsMapXYZI>();
    points->resize(indices.size());
    for (std::size_t k = 0; k < indices.size(); ++k) {
        const std::uint32_t i = indices[k];
        points->setPointFast(k, xs[i], ys[i], zs[i]);
        points->setPointColor_fast(k, intensities[i], 0.0F, 0.0F);
    }
    points->mark_as_modified();
    out.points = std::move(points);
    if (cloud.scene_index.empty()) {
        out.scene_index = indices;
    } else {
        out.scene_index.reserve(indices.size());
        for (const std::uint32_t i : indices) out.scene_index.push_back(cloud.scene_index[i]);
    }
    return out;
}

}  // namespace petal
