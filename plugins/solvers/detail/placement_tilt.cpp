// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "solvers/detail/placement_tilt.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "petal/calibration/angles.hpp"
#include "petal/printed.hpp"

namespace petal {

std::optional<PlacementTilt> least_tilt(const std::vector<Eigen::Vector3d>& normals) {
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    for (const Eigen::Vector3d& normal : normals) mean += normal;
    if (normals.size() < 2 || mean.norm() < 1e-6 * static_cast<double>(normals.size()))
        return std::nullopt;
    mean.normalize();
    const Eigen::Vector3d u = mean.unitOrthogonal(), v = mean.cross(u);
    Eigen::Matrix2d scatter = Eigen::Matrix2d::Zero();
    for (const Eigen::Vector3d& normal : normals) {
        const Eigen::Vector2d off(std::asin(std::clamp(normal.dot(u), -1.0, 1.0)),
                                  std::asin(std::clamp(normal.dot(v), -1.0, 1.0)));
        scatter += off * off.transpose() / static_cast<double>(normals.size());
    }
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> eigen(scatter);
    // A normal moves along `direction` where its board turns about what is square to it.
    const Eigen::Vector2d direction = eigen.eigenvectors().col(0);
    return PlacementTilt{std::sqrt(std::max(0.0, eigen.eigenvalues()[0])),
                         mean.cross(u * direction.x() + v * direction.y()).normalized()};
}

std::optional<std::string> tilt_doubt(const PlacementTilt& tilt, double least_deg) {
    if (tilt.spread * kDegrees >= least_deg) return std::nullopt;
    const bool pitch = std::abs(tilt.axis.x()) >= std::abs(tilt.axis.y());
    return printed(
               "the boards are turned by only %.1f deg (RMS; usable from %.1f deg) against each "
               "other about the camera's ",
               tilt.spread * kDegrees, least_deg) +
           (pitch ? "x" : "y") +
           " axis, so that an error about it that all share would not show; add a board that " +
           (pitch ? "leans forwards or backwards" : "is turned to the left or right") +
           " by 20 deg";
}

}  // namespace petal
