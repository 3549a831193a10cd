// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "metrics/detail/point_to_edge.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

#include "petal/calibration/polygon.hpp"

namespace petal {
namespace {

constexpr double kBeside = 0.03;    // m from a side, on the board
constexpr double kOffPlane = 0.05;  // m

/// Each hole as indices of Target::corners().
std::vector<std::vector<std::size_t>> holes_by_corner(const Target& target) {
    const auto corners = target.corners();
    std::vector<std::vector<std::size_t>> holes;
    for (const auto& hole : target.holes) {
        std::vector<std::size_t> indices;
        for (const Eigen::Vector2d& p : hole) {
            const auto at =
                std::min_element(corners.begin(), corners.end(), [&](const auto& a, const auto& b) {
                    return (a - p).squaredNorm() < (b - p).squaredNorm();
                });
            indices.push_back(static_cast<std::size_t>(at - corners.begin()));
        }
        holes.push_back(std::move(indices));
    }
    return holes;
}

}  // namespace

std::vector<double> point_to_edge(const CameraModel& model, const Eigen::Isometry3d& T_camera_lidar,
                                  const Cloud& cloud, const LidarBoard& lidar,
                                  const ImageBoard& image, const PosedMatch& match,
                                  const Target& target) {
    std::vector<double> distances;
    if (target.holes.empty() || target.corners().size() != image.corners.size()) return distances;
    // Where the image has the corner that is corner k of the LiDAR's board.
    std::vector<Eigen::Vector2d> image_of(image.corners.size());
    for (std::size_t i = 0; i < match.order.size(); ++i)
        image_of[match.order[i]] = image.corners[i];
    std::vector<std::vector<Eigen::Vector2d>> in_image;
    for (const auto& hole : holes_by_corner(target)) {
        std::vector<Eigen::Vector2d> ring;
        ring.reserve(hole.size());
        for (const std::size_t k : hole) ring.push_back(image_of[k]);
        in_image.push_back(std::move(ring));
    }
    const Eigen::Isometry3d to_board = lidar.T_lidar_board.inverse();
    for (std::size_t i = 0; i < cloud.size(); ++i) {
        float x = 0.0F, y = 0.0F, z = 0.0F;
        cloud.points->getPoint(i, x, y, z);
        const Eigen::Vector3d p(static_cast<double>(x), static_cast<double>(y),
                                static_cast<double>(z));
        const Eigen::Vector3d on_board = to_board * p;
        if (!(std::abs(on_board.z()) <= kOffPlane)) continue;
        double nearest = kBeside;
        std::size_t hole = target.holes.size();
        for (std::size_t h = 0; h < target.holes.size(); ++h) {
            const double distance = distance_to_polygon(target.holes[h], on_board.head<2>());
            if (distance >= nearest) continue;
            nearest = distance;
            hole = h;
        }
        if (hole == target.holes.size()) continue;
        if (const auto pixel = model.project(T_camera_lidar * p))
            distances.push_back(distance_to_polygon(in_image[hole], *pixel));
    }
    return distances;
}

}  // namespace petal
