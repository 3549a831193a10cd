// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "detectors/detail/image_hole_walls.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <optional>

#include "detectors/detail/median_value.hpp"

namespace petal {
namespace {

constexpr double kLeastContrast = 0.05;

/// The camera's centre in the board frame: z < 0. None for a homography that no pose has.
std::optional<Eigen::Vector3d> camera_centre(const Homography& board_to_ideal,
                                             const mrpt::img::TCamera& camera) {
    Eigen::Matrix3d K = Eigen::Matrix3d::Identity();
    K(0, 0) = camera.fx();
    K(1, 1) = camera.fy();
    K(0, 2) = camera.cx();
    K(1, 2) = camera.cy();
    Eigen::Matrix3d m = K.inverse() * board_to_ideal;
    const double scale = std::sqrt(m.col(0).norm() * m.col(1).norm());
    if (!(scale > 0.0)) return std::nullopt;
    m /= m(2, 2) > 0.0 ? scale : -scale;
    const Eigen::Vector3d x = m.col(0).normalized();
    const Eigen::Vector3d z = x.cross(m.col(1)).normalized();
    Eigen::Matrix3d R;
    R << x, z.cross(x), z;
    const Eigen::Vector3d centre = -R.transpose() * m.col(2);
    if (!centre.allFinite() || centre.z() >= 0.0) return std::nullopt;
    return centre;
}

}  // namespace

int HoleWalls::axis(std::size_t side) const {
    const Eigen::Vector2d along = layout_.sides()[side].to - layout_.sides()[side].from;
    return std::abs(along.x()) > std::abs(along.y()) ? 1 : 0;
}

std::vector<double> HoleWalls::shown(const Homography& board_to_ideal) const {
    std::vector<double> walls(layout_.sides().size(), 0.0);
    const double thickness = layout_.target().thickness;
    const auto centre = camera_centre(board_to_ideal, camera_);
    if (!centre || thickness <= 0.0) return walls;
    for (std::size_t s = 0; s < walls.size(); ++s) {
        const auto& side = layout_.sides()[s];
        const Eigen::Vector2d along = (side.to - side.from).normalized();
        const Eigen::Vector2d outwards(along.y(), -along.x());
        const Eigen::Vector2d towards = centre->head<2>() - 0.5 * (side.from + side.to);
        walls[s] = std::max(0.0, -towards.dot(outwards) * thickness / (thickness - centre->z()));
    }
    return walls;
}

std::array<HoleWalls::Share, 2> HoleWalls::share(const std::vector<double>& shown,
                                                 const std::array<Share, 2>& explained,
                                                 const std::vector<double>& insets,
                                                 const std::vector<bool>& measured,
                                                 const Sight& sight) const {
    const Share expected = expected_wall_share(std::max(sight.contrast, kLeastContrast));
    std::array<Share, 2> shares{expected, expected};
    for (int axis_index = 0; axis_index < 2; ++axis_index) {
        std::vector<double> inset;
        double wall = 0.0;
        for (std::size_t s = 0; s < shown.size(); ++s) {
            if (!measured[s] || axis(s) != axis_index) continue;
            inset.push_back(insets[s]);
            wall += shown[s];
        }
        if (!(wall > 0.0)) continue;
        // Half of the sides show no wall, but the fit of the whole board gives them half of it.
        wall /= static_cast<double>(inset.size());
        auto& share = shares[static_cast<std::size_t>(axis_index)];
        const double seen =
            explained[static_cast<std::size_t>(axis_index)].mean + median_value(inset) / wall;
        const double sigma = kInsetSigmaPx / sight.px_per_m / wall;
        const double weight =
            share.sigma * share.sigma / (share.sigma * share.sigma + sigma * sigma);
        share.mean = std::max(0.0, share.mean + weight * (seen - share.mean));
        share.sigma *= std::sqrt(1.0 - weight);
    }
    return shares;
}

}  // namespace petal
