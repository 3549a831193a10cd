// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "metrics/detail/displayed_edges.hpp"

#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <map>

#include "petal/calibration/camera_model.hpp"

namespace petal {
namespace {

/// A corner in the LiDAR frame: as the LiDAR has it, and as the camera shows it on the board.
struct ShownCorner {
    Eigen::Vector3d real, shown;
};

}  // namespace

std::vector<std::pair<int, int>> hole_sides(const Target& target) {
    const auto corners = target.corners();
    const auto index_of = [&corners](const Eigen::Vector2d& p) {
        const auto nearest =
            std::min_element(corners.begin(), corners.end(), [&p](const auto& a, const auto& b) {
                return (a - p).squaredNorm() < (b - p).squaredNorm();
            });
        return static_cast<int>(nearest - corners.begin());
    };
    std::vector<std::pair<int, int>> sides;
    for (const auto& hole : target.holes)
        for (std::size_t i = 0; i < hole.size(); ++i)
            sides.emplace_back(index_of(hole[i]), index_of(hole[(i + 1) % hole.size()]));
    return sides;
}

std::optional<std::vector<double>> displayed_distances(
    const SeenBoard& board, const std::vector<std::pair<int, int>>& sides) {
    std::vector<const PointPair*> finite;
    Eigen::Vector3d middle = Eigen::Vector3d::Zero();
    for (const PointPair& corner : board.corners)
        if (corner.lidar.allFinite() && corner.image.allFinite()) {
            finite.push_back(&corner);
            middle += corner.lidar;
        }
    if (finite.size() < 3) return std::nullopt;
    middle /= static_cast<double>(finite.size());
    Eigen::Matrix3Xd off(3, static_cast<Eigen::Index>(finite.size()));
    for (std::size_t i = 0; i < finite.size(); ++i)
        off.col(static_cast<Eigen::Index>(i)) = finite[i]->lidar - middle;
    const Eigen::Vector3d normal =
        Eigen::JacobiSVD<Eigen::Matrix3Xd>(off, Eigen::ComputeFullU).matrixU().col(2);

    const CameraModel model(board.model);
    const Eigen::Isometry3d T_lidar_camera = board.T_camera_lidar.inverse();
    const Eigen::Vector3d centre = T_lidar_camera.translation();
    std::map<int, ShownCorner> shown;
    for (const PointPair* corner : finite) {
        const auto ray = model.unproject(corner->image);
        if (!ray) return std::nullopt;
        const Eigen::Vector3d direction = T_lidar_camera.linear() * *ray;
        const double along = normal.dot(middle - centre) / normal.dot(direction);
        if (!(along > 0.0) || !std::isfinite(along)) return std::nullopt;
        shown[corner->corner] = {corner->lidar, centre + along * direction};
    }
    std::vector<double> distances;
    for (const auto& [from, to] : sides) {
        const auto a = shown.find(from), b = shown.find(to);
        if (a == shown.end() || b == shown.end()) continue;
        const Eigen::ParametrizedLine<double, 3> edge =
            Eigen::ParametrizedLine<double, 3>::Through(a->second.real, b->second.real);
        distances.push_back(
            std::max(edge.distance(a->second.shown), edge.distance(b->second.shown)));
    }
    if (sides.empty())
        for (const auto& [index, corner] : shown)
            distances.push_back((corner.shown - corner.real).norm());
    return distances;
}

}  // namespace petal
