// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "solvers/detail/board_symmetry.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace petal {
namespace {

/// Coordinates in the best plane, from the centroid.
std::vector<Eigen::Vector2d> flatten(const std::vector<Eigen::Vector3d>& corners) {
    Eigen::Vector3d centre = Eigen::Vector3d::Zero();
    for (const auto& corner : corners) centre += corner;
    centre /= static_cast<double>(corners.size());
    Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
    for (const auto& corner : corners) scatter += (corner - centre) * (corner - centre).transpose();
    const Eigen::Matrix3d axes =
        Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(scatter).eigenvectors();
    std::vector<Eigen::Vector2d> flat;
    flat.reserve(corners.size());
    for (const auto& corner : corners)
        flat.emplace_back(axes.col(2).dot(corner - centre), axes.col(1).dot(corner - centre));
    return flat;
}

/// Where every corner goes under a rotation; none where one goes nowhere, or two to one place.
std::optional<CornerOrder> match(const std::vector<Eigen::Vector2d>& flat, double angle,
                                 double tolerance) {
    const double c = std::cos(angle), s = std::sin(angle);
    CornerOrder order;
    for (const auto& point : flat) {
        const Eigen::Vector2d turned(c * point.x() - s * point.y(), s * point.x() + c * point.y());
        std::size_t nearest = 0;
        for (std::size_t i = 1; i < flat.size(); ++i)
            if ((flat[i] - turned).norm() < (flat[nearest] - turned).norm()) nearest = i;
        if ((flat[nearest] - turned).norm() > tolerance) return std::nullopt;
        if (std::find(order.begin(), order.end(), nearest) != order.end()) return std::nullopt;
        order.push_back(nearest);
    }
    return order;
}

}  // namespace

std::vector<CornerOrder> board_rotations(const std::vector<Eigen::Vector3d>& corners) {
    CornerOrder identity(corners.size());
    for (std::size_t i = 0; i < identity.size(); ++i) identity[i] = i;
    std::vector<CornerOrder> rotations{identity};
    if (corners.size() < 2) return rotations;

    const auto flat = flatten(corners);
    double neighbour = 0.0;
    for (std::size_t i = 0; i < flat.size(); ++i) {
        double least = std::numeric_limits<double>::infinity();
        for (std::size_t j = 0; j < flat.size(); ++j)
            if (j != i) least = std::min(least, (flat[i] - flat[j]).norm());
        neighbour += least / static_cast<double>(flat.size());
    }
    // Wide, since outdoors measured holes are a quarter too small in one direction; that no two
    // corners go to one place keeps it unambiguous.
    const double tolerance = 0.45 * neighbour;
    // The corner furthest out tells the angles that can be: it must land on a corner as far out.
    const auto outer = *std::max_element(
        flat.begin(), flat.end(), [](const auto& a, const auto& b) { return a.norm() < b.norm(); });
    std::vector<std::pair<double, CornerOrder>> found;
    for (const auto& goal : flat) {
        if (std::abs(goal.norm() - outer.norm()) > tolerance) continue;
        double angle = std::atan2(goal.y(), goal.x()) - std::atan2(outer.y(), outer.x());
        if (angle < 0.0) angle += 2.0 * 3.14159265358979323846;
        if (auto order = match(flat, angle, tolerance)) found.emplace_back(angle, *order);
    }
    std::stable_sort(found.begin(), found.end(),
                     [](const auto& a, const auto& b) { return a.first < b.first; });
    for (const auto& [angle, order] : found)
        if (std::find(rotations.begin(), rotations.end(), order) == rotations.end())
            rotations.push_back(order);
    return rotations;
}

}  // namespace petal
