// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <mrpt/maps/CPointsMapXYZI.h>

#include <Eigen/Geometry>
#include <cmath>
#include <limits>
#include <string>

#include "detectors/detail/lidar_template_fit.hpp"
#include "noise.hpp"
#include "petal/calibration/cloud.hpp"
#include "petal/calibration/plane_fit.hpp"
#include "petal/calibration/target.hpp"

namespace petal::testing {

/// Rays of a LiDAR at the origin over a window of its view onto a board and, `gap` behind it, a
/// wall (none: 0). Thin beams; the plate looks larger by `shift` on every side. Range noise 10 mm.
struct RayWorld {
    Eigen::Isometry3d T_lidar_board = Eigen::Isometry3d::Identity();
    std::string target = "four_square_holes_500mm";
    double gap = 0.4;
    double shift = 0.0;
    double scale = 1.0;  ///< of the board against its target file
    double walls = 0.0;  ///< m: how deep the holes are
    /// Behind what lies lower on the board than this (m from its middle, down) it is `darkness`
    /// times the factor e darker; there the plate looks larger by `glare` for each of them.
    double dark_from = std::numeric_limits<double>::infinity();
    double darkness = 1.0, glare = 0.0;
    bool intensities = true;
    int rays = 60000;
    bool holes = true;

    Cloud cast(Rng& rng) const {
        const Target file = load_target(target);
        const PlateTemplate plate(file);
        auto map = mrpt::maps::CPointsMapXYZI::Create();
        const Eigen::Isometry3d to_board = T_lidar_board.inverse();
        const Eigen::Vector3d sensor = to_board.translation();
        const Eigen::Vector3d middle =
            T_lidar_board * Eigen::Vector3d(plate.all.middle().x(), plate.all.middle().y(), 0.0);
        const double reach = 2.0 * plate.all.radius() / middle.norm();
        const Eigen::Vector3d ahead = middle.normalized();
        const Eigen::Vector3d left = Eigen::Vector3d::UnitZ().cross(ahead).normalized();
        for (int i = 0; i < rays; ++i) {
            const Eigen::Vector3d ray = (ahead + uniform(rng, -reach, reach) * left +
                                         uniform(rng, -reach, reach) * ahead.cross(left))
                                            .normalized();
            const Eigen::Vector3d on = to_board.linear() * ray;
            double range = -sensor.z() / on.z();
            const Eigen::Vector2d at = (sensor + range * on).head<2>() / scale - plate.all.middle();
            const double inside = holes                      ? plate.all.edge(at).inside * scale
                                  : plate.all.in_outline(at) ? 1.0
                                                             : -plate.all.distance_to_outline(at);
            const Eigen::Vector2d deeper = at + walls / on.z() * on.head<2>();
            const bool dark = at.y() > dark_from;
            const double larger = shift + (dark ? glare * darkness : 0.0);
            double brightness = 0.5;
            if (inside + larger <= 0.0 && (walls == 0.0 || plate.all.edge(deeper).inside <= 0.0)) {
                if (!(gap > 0.0)) continue;
                range += gap / on.z();
                if (dark) brightness *= std::exp(-darkness);
            }
            const Eigen::Vector3d p = (range + normal(rng, 0.010)) * ray;
            map->insertPoint(static_cast<float>(p.x()), static_cast<float>(p.y()),
                             static_cast<float>(p.z()));
            if (intensities)
                map->setPointIntensity(map->size() - 1, static_cast<float>(brightness));
        }
        Cloud cloud;
        cloud.points = map;
        return cloud;
    }
};

/// Of the upper left corner of a board whose middle is `distance` ahead; angles in rad.
inline Eigen::Isometry3d facing_pose(double distance, double yaw, double pitch, double roll,
                                     double width = 0.5, double height = 0.5) {
    const Eigen::Vector3d normal = Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()) *
                                   Eigen::AngleAxisd(pitch, Eigen::Vector3d::UnitY()) *
                                   Eigen::Vector3d(-1.0, 0.0, 0.0);
    return plane_frame(normal, {distance, 0.3, -0.2}) *
           Eigen::AngleAxisd(roll, Eigen::Vector3d::UnitZ()) *
           Eigen::Translation3d(-width / 2.0, -height / 2.0, 0.0);
}

}  // namespace petal::testing
