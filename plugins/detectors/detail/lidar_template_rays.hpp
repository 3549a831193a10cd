// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstddef>
#include <functional>
#include <limits>
#include <vector>

#include "detectors/detail/cloud_directions.hpp"

namespace petal {

/// A ray that crosses a plane near a place, and how far from the plane it returned.
struct PlaneRay {
    Eigen::Vector3d point = Eigen::Vector3d::Zero();  ///< what returned, m, LiDAR frame
    Eigen::Vector2d place =
        Eigen::Vector2d::Zero();  ///< where the ray crosses the plane, in the plane's frame
    double beyond = 0.0;      ///< m along the ray from the plane to the point; negative: before it
    double log_energy = 0.0;  ///< logarithm of its intensity over its squared range
};

/// What a ray tells of the plate.
enum class Told { hit, miss, nothing };

/// The rays of a cloud that cross a plane within a radius of a place.
struct RayBundle {
    Eigen::Isometry3d T_lidar_plane = Eigen::Isometry3d::Identity();  ///< z away from the sensor
    double radius = 0.0;
    std::vector<PlaneRay> rays;
    std::size_t crossed = 0;   ///< how many there were to choose `rays` from
    double range_sigma = 0.0;  ///< m: robust scatter of those on the plane
    double hit_depth = 0.0;    ///< m: a ray that returned not farther than this from the plane hit
    double gap = 0.0;          ///< m: from the plane to the nearest surface behind it; 0: none

    Told told(const PlaneRay& ray) const {
        if (ray.beyond > hit_depth) return Told::miss;
        return ray.beyond >= -hit_depth ? Told::hit : Told::nothing;
    }
};

/// Gathers them by their direction; of more than `most` about `most` to half as many, evenly. Rays
/// that cross flatter than 6 deg show no place.
RayBundle gather_rays(const CloudDirections& directions, const Eigen::Isometry3d& T_lidar_plane,
                      double radius, std::size_t most = std::numeric_limits<std::size_t>::max());

/// The same rays with another plane.
void replace_plane(RayBundle& rays, const Eigen::Isometry3d& T_lidar_plane);

/// Where of the plane a ray crosses it.
using PlacesOfPlane = std::function<bool(const Eigen::Vector2d& place)>;

/// Measures the noise of ranges on the plate's places, and from it and the nearest surface behind
/// the others what a hit is: within three sigma, and within half the way to that surface.
void measure_ranges(RayBundle& rays, const PlacesOfPlane& plate, const PlacesOfPlane& open);

/// A robust plane through the rays within `radius` of the origin that returned near the plane;
/// false where they are too few. The frame keeps its origin's ray.
bool fit_plane(RayBundle& rays, double radius, double depth);

}  // namespace petal
